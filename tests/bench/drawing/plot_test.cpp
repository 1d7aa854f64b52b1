// SPDX-License-Identifier: Apache-2.0
#include "bench/drawing/plot.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace mh {
namespace {

/// Middles of the dots of the first color, by row and column, in each panel of an image; the
/// legend's stand among them.
std::vector<cv::Point2d> dots_in(const cv::Mat& image) {
  cv::Mat is_dot, components, statistics, middles;
  cv::inRange(image, cv::Scalar(160, 99, 11), cv::Scalar(200, 139, 51), is_dot);  // BGR
  const int count = cv::connectedComponentsWithStats(is_dot, components, statistics, middles);
  std::vector<cv::Point2d> dots;
  for (int k = 1; k < count; ++k)
    if (statistics.at<int>(k, cv::CC_STAT_AREA) >= 8)
      dots.emplace_back(middles.at<double>(k, 0), middles.at<double>(k, 1));
  return dots;
}

/// The dot nearest to a place.
cv::Point2d nearest(const std::vector<cv::Point2d>& dots, cv::Point2d place) {
  return *std::min_element(dots.begin(), dots.end(), [&](const auto& a, const auto& b) {
    return cv::norm(a - place) < cv::norm(b - place);
  });
}

Plot square_of_dots() {
  return {"", "", "", {{"", true, {{0, 0}, {10, 0}, {0, 20}, {10, 20}, {4, 15}}}}};
}

// The corners of the data are those of the axes, for 0, 10 and 20 are round numbers.
TEST(DrawPlots, DotsStandWhereTheirNumbersSay) {
  const cv::Mat image = draw_plots("", {square_of_dots()});
  const std::vector<cv::Point2d> dots = dots_in(image);
  ASSERT_EQ(dots.size(), 6u) << "five and the legend's";
  const double bottom = 344, top = 108, left = 82, right = 450;
  const cv::Point2d low_left = nearest(dots, {left, bottom}),
                    low_right = nearest(dots, {right, bottom}),
                    high_left = nearest(dots, {left, top});
  EXPECT_NEAR(low_left.y, low_right.y, 0.3);
  EXPECT_NEAR(low_left.x, high_left.x, 0.3);
  EXPECT_GT(low_right.x - low_left.x, 300);
  EXPECT_GT(low_left.y - high_left.y, 200);
  const cv::Point2d inside =
      low_left + 0.4 * (low_right - low_left) + 0.75 * (high_left - low_left);
  EXPECT_LT(cv::norm(nearest(dots, inside) - inside), 0.5);
}

TEST(DrawPlots, StandThreeInARowEachInAPanelOfItsOwn) {
  const auto first = [](const std::vector<Plot>& plots) { return dots_in(draw_plots("", plots)); };
  const std::vector<cv::Point2d> one = first({square_of_dots()});
  const Plot none{"", "", "", {}};
  const auto shift = [&](std::size_t place) {
    std::vector<Plot> plots(place, none);
    plots.push_back(square_of_dots());
    const std::vector<cv::Point2d> moved = first(plots);
    EXPECT_EQ(moved.size(), one.size());
    for (std::size_t k = 1; k < one.size(); ++k)
      EXPECT_LT(cv::norm((moved[k] - one[k]) - (moved[0] - one[0])), 0.1);
    return moved[0] - one[0];
  };
  const cv::Point2d right = shift(1), below = shift(3);
  EXPECT_GT(right.x, 400);
  EXPECT_NEAR(right.y, 0, 0.1);
  EXPECT_LT(cv::norm(shift(2) - 2 * right), 0.1);
  EXPECT_NEAR(below.x, 0, 0.1);
  EXPECT_GT(below.y, 300);
  EXPECT_LT(cv::norm(shift(4) - right - below), 0.1);
}

// An axis begins at zero where the least value lies below half of the greatest.
TEST(DrawPlots, AnAxisBeginsAtZeroUnlessAllIsFarFromIt) {
  const auto spread = [](double low) {  // of two dots at low and 10, in px
    const Plot plot{"", "", "", {{"", true, {{low, 0}, {10, 0}}}}};
    std::vector<cv::Point2d> dots = dots_in(draw_plots("", {plot}));
    std::sort(dots.begin(), dots.end(), [](auto a, auto b) { return a.y > b.y; });
    return std::abs(dots[0].x - dots[1].x);  // the lowest two: not the legend's
  };
  EXPECT_NEAR(spread(4), 0.6 * spread(0), 1);
  EXPECT_GT(spread(6), 0.9 * spread(0));
}

}  // namespace
}  // namespace mh
