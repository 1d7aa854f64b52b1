// SPDX-License-Identifier: Apache-2.0
#include "slam/features/corners.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "slam/core/random.hpp"

namespace mh {
namespace {

std::vector<Corner> random_corners(int count, int width, int height, std::uint64_t seed) {
  const RandomStream random(seed);
  std::vector<Corner> corners;
  for (int i = 0; i < count; ++i) {
    const RandomStream r = random.fork(static_cast<std::uint64_t>(i));
    corners.push_back({static_cast<std::int16_t>(r.below(0, static_cast<std::uint64_t>(width))),
                       static_cast<std::int16_t>(r.below(1, static_cast<std::uint64_t>(height))),
                       static_cast<std::int16_t>(7 + r.below(2, 100))});
  }
  std::sort(corners.begin(), corners.end(), stronger);
  corners.erase(std::unique(corners.begin(), corners.end(),
                            [](auto& a, auto& b) { return a.x == b.x && a.y == b.y; }),
                corners.end());
  return corners;
}

int closest_pair(const std::vector<Corner>& corners) {
  int closest = 1 << 20;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      closest = std::min(closest, std::max(std::abs(corners[i].x - corners[j].x),
                                           std::abs(corners[i].y - corners[j].y)));
  return closest;
}

TEST(Spread, ReturnsExactlyAsManyAsAskedForAndOnlyWhatItWasGiven) {
  const std::vector<Corner> corners = random_corners(3000, 640, 480, 1);
  for (const int count : {0, 1, 2, 100, 999, 2500, 5000}) {
    const std::vector<Corner> picked = spread(corners, count);
    EXPECT_EQ(picked.size(),
              std::min<std::size_t>(corners.size(), static_cast<std::size_t>(count)));
    EXPECT_TRUE(std::is_sorted(picked.begin(), picked.end(), stronger));
    EXPECT_TRUE(
        std::includes(corners.begin(), corners.end(), picked.begin(), picked.end(), stronger));
  }
}

TEST(Spread, KeepsTheStrongestAndWideSpacing) {
  const std::vector<Corner> corners = random_corners(3000, 640, 480, 2);
  const std::vector<Corner> picked = spread(corners, 200);
  EXPECT_EQ(picked.front(), corners.front());
  // 200 squares of side 39 px tile the picture; greedy picking reaches a good half of that.
  EXPECT_GE(closest_pair(picked), 20);
}

TEST(Spread, ALineOfCornersIsThinnedEvenly) {
  std::vector<Corner> corners;
  for (int x = 0; x < 600; ++x) corners.push_back({static_cast<std::int16_t>(x), 100, 50});
  const std::vector<Corner> picked = spread(corners, 60);
  ASSERT_EQ(picked.size(), 60U);
  EXPECT_GE(closest_pair(picked), 9);
}

TEST(FindCorners, FindsTheSameAsFastOverTheWholeImageWhereEveryCellHasSome) {
  cv::Mat image(480, 640, CV_8U);
  const RandomStream random(3);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x)
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(
          random.below(static_cast<std::uint64_t>((y / 9) * 1000 + x / 9), 256));
  cv::GaussianBlur(image, image, {5, 5}, 0.8);
  const std::vector<Corner> corners = find_corners(image, 19, 20, 7);
  std::vector<cv::KeyPoint> all;
  cv::FAST(image, all, 20, true);
  std::size_t inside = 0;
  for (const cv::KeyPoint& k : all)
    inside += k.pt.x >= 19 && k.pt.y >= 19 && k.pt.x < 640 - 19 && k.pt.y < 480 - 19;
  EXPECT_GT(inside, 500U);
  EXPECT_EQ(corners.size(), inside);
}

TEST(FindCorners, LowThresholdFindsNothingTwice) {
  // Weak corners right at the rims of cells, some of which hold strong corners.
  cv::Mat image(480, 640, CV_8U, cv::Scalar(100));
  for (int i = 0; i < 400; ++i) {
    const RandomStream r = RandomStream(4).fork(static_cast<std::uint64_t>(i));
    const cv::Rect square(static_cast<int>(r.below(0, 600)), static_cast<int>(r.below(1, 440)), 12,
                          12);
    image(square).setTo(i % 10 == 0 ? 200 : 112);
  }
  cv::GaussianBlur(image, image, {5, 5}, 0.8);
  const std::vector<Corner> corners = find_corners(image, 19, 20, 7);
  ASSERT_GT(corners.size(), 300U);
  EXPECT_GE(closest_pair(corners), 2);  // local maxima do not touch, not even across cells
}

TEST(ShareOut, FollowsAGeometricSeriesAndSumsToTheTotal) {
  const std::vector<int> share = share_out(1000, 1 / 1.2, std::vector<int>(8, 100000));
  EXPECT_EQ(std::accumulate(share.begin(), share.end(), 0), 1000);
  for (std::size_t l = 1; l < share.size(); ++l) EXPECT_NEAR(share[l - 1], 1.2 * share[l], 2.0);
}

TEST(ShareOut, WhatALevelLacksGoesToOthers) {
  EXPECT_EQ(share_out(100, 0.5, {10, 500, 500}), (std::vector<int>{10, 76, 14}));
  EXPECT_EQ(share_out(100, 0.5, {500, 0, 5}), (std::vector<int>{95, 0, 5}));
  EXPECT_EQ(share_out(100, 0.5, {1, 2, 3}), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(share_out(0, 0.5, {1, 2, 3}), (std::vector<int>{0, 0, 0}));
  EXPECT_TRUE(share_out(100, 0.5, {}).empty());
}

}  // namespace
}  // namespace mh
