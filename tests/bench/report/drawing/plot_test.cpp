// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/plot.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "bench/report/drawing/gnuplot.hpp"
#include "scenes/image_file.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class Plots : public testing::Test {
 protected:
  cv::Mat drawn(const std::vector<Plot>& plots) const {
    const fs::path file = work_.path() / "plots.png";
    write_plots(file, {"", plots});
    return read_image(file, ImageForm::kColor);
  }

  /// Centers of the dots in the first color.
  static std::vector<cv::Point2d> dots_in(const cv::Mat& image) {
    cv::Mat is_dot, components, statistics, middles;
    cv::inRange(image, cv::Scalar(150, 89, 0), cv::Scalar(210, 149, 71), is_dot);  // BGR
    const int count = cv::connectedComponentsWithStats(is_dot, components, statistics, middles);
    std::vector<cv::Point2d> dots;
    for (int k = 1; k < count; ++k)
      if (statistics.at<int>(k, cv::CC_STAT_AREA) >= 6)
        dots.emplace_back(middles.at<double>(k, 0), middles.at<double>(k, 1));
    return dots;
  }
  std::vector<cv::Point2d> dots(const std::vector<Plot>& plots) const {
    return dots_in(drawn(plots));
  }

  TemporaryFolder work_{fs::temp_directory_path()};
};

Plot dots_at(std::vector<Series::Point> points) {
  return {"", "", "", {{"", true, std::move(points)}}};
}

TEST_F(Plots, DotsStandWhereTheirNumbersSay) {
  std::vector<cv::Point2d> at = dots({dots_at({{0, 0}, {10, 0}, {0, 20}, {10, 20}, {4, 15}})});
  ASSERT_EQ(at.size(), 5U);
  const auto by = [&](auto key) { return *std::ranges::min_element(at, {}, key); };
  const cv::Point2d low_left = by([](cv::Point2d p) { return p.x - p.y; });
  const cv::Point2d low_right = by([](cv::Point2d p) { return -p.x - p.y; });
  const cv::Point2d high_left = by([](cv::Point2d p) { return p.x + p.y; });
  EXPECT_NEAR(low_left.y, low_right.y, 0.6);
  EXPECT_NEAR(low_left.x, high_left.x, 0.6);
  EXPECT_GT(low_right.x - low_left.x, 250);
  EXPECT_GT(low_left.y - high_left.y, 150);
  const cv::Point2d inside =
      low_left + 0.4 * (low_right - low_left) + 0.75 * (high_left - low_left);
  EXPECT_TRUE(std::ranges::any_of(at, [&](cv::Point2d p) { return cv::norm(p - inside) < 1.2; }));
}

TEST_F(Plots, StandThreeInARowEachInAPanelOfItsOwn) {
  const Plot plot = dots_at({{0, 0}, {10, 20}}), none{"", "", "", {}};
  const auto first = [&](std::size_t place) {
    std::vector<Plot> plots(place, none);
    plots.push_back(plot);
    const std::vector<cv::Point2d> at = dots(plots);
    EXPECT_EQ(at.size(), 2U);
    return *std::ranges::max_element(at, {}, &cv::Point2d::y);
  };
  EXPECT_GT(first(1).x - first(0).x, 300);
  EXPECT_NEAR(first(2).x - first(1).x, first(1).x - first(0).x, 2);
  EXPECT_NEAR(first(2).y, first(0).y, 1);
  EXPECT_NEAR(first(3).x, first(0).x, 1);
  EXPECT_GT(first(3).y - first(2).y, 200);
}

TEST_F(Plots, AnAxisBeginsAtZeroUnlessAllIsFarFromIt) {
  const auto spread = [&](double low) {
    const std::vector<cv::Point2d> at = dots({dots_at({{low, 0}, {10, 1}})});
    EXPECT_EQ(at.size(), 2U);
    return std::abs(at[0].x - at[1].x);
  };
  EXPECT_NEAR(spread(4), 0.6 * spread(0), 2);
  EXPECT_GT(spread(6), 0.9 * spread(0));
}

TEST_F(Plots, AnAxisHasTheRangeThatIsGiven) {
  PlotPage page{"", {{"a", "x", "y", {{"", true, {{1, 10}, {2, 20}}}}}}};
  page.plots[0].x_range = {0, 60};
  page.plots[0].y_range = {0, 100};
  const std::string script = plots_script(page, "a.png");
  EXPECT_NE(script.find("set xrange [0:60]\nset yrange [0:100]"), std::string::npos) << script;
}

TEST_F(Plots, AFieldShadesItsCellsFromTheLeastToTheMost) {
  ShadedField field{.marks = {{0, 0, 1.0, "1"}, {1, 0, 3.0, "3"}},
                    .x_ticks = {{0, "a"}, {1, "b\n(5 %)"}},
                    .y_ticks = {},
                    .low_color = "#00ff00",
                    .high_color = "#0000ff",
                    .framed = 1};
  const cv::Mat image = drawn({{"", "", "", {}, field}});
  const auto area = [&](const cv::Scalar& bgr) {
    cv::Mat same;
    cv::inRange(image, bgr, bgr, same);
    cv::Mat points;
    cv::findNonZero(same, points);
    return cv::boundingRect(points);
  };
  const cv::Rect least = area({0, 255, 0}), most = area({255, 0, 0});
  EXPECT_GT(least.area(), 5000);
  EXPECT_NEAR(least.width, most.width, 8);
  EXPECT_LT(least.x, most.x);
  EXPECT_GT(area({40, 39, 214}).width, 0.9 * most.width) << "the frame";
}

TEST_F(Plots, TextsStayTexts) {
  EXPECT_EQ(gnuplot_text("it's `date`"), "'it\u2019s `date`'");
  EXPECT_EQ(gnuplot_text("a\nb"), "'a'.\"\\n\".'b'");
  EXPECT_EQ(gnuplot_text(""), "''");
  Plot plot = dots_at({{0, 0}, {1, 1}});
  plot.title = plot.series[0].name = "'; system('touch x'); {/Symbol a} \"";
  EXPECT_FALSE(drawn({plot}).empty());
}

TEST_F(Plots, AnotherKindOfFileIsRefusedAndNothingIsLeftBehind) {
  const fs::path file = work_.path() / "plots.jpg";
  EXPECT_THROW(write_plots(file, {"", {dots_at({{0, 0}, {1, 1}})}}), InputError);
  EXPECT_FALSE(fs::exists(file));
}

TEST_F(Plots, APdfIsWrittenByItsExtension) {
  const fs::path file = work_.path() / "plots.pdf";
  Plot plot = dots_at({{0, 0}, {1, 1}});
  plot.title = "title";
  write_plots(file, {"page", {plot}});
  const std::string pdf = read_file(file);
  EXPECT_TRUE(pdf.starts_with("%PDF"));
}

}  // namespace
}  // namespace mh
