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
  // 200 squares with sides of 39 px tile the image; greedy picking reaches about half of that
  // spacing, and the test asks for half of that again.
  EXPECT_GE(closest_pair(picked), 10);
}

TEST(Spread, ALineOfCornersIsThinnedEvenly) {
  std::vector<Corner> corners;
  for (int x = 0; x < 600; ++x)
    corners.push_back({.x = static_cast<std::int16_t>(x), .y = 100, .strength = 50});
  const std::vector<Corner> picked = spread(corners, 60);
  ASSERT_EQ(picked.size(), 60U);
  EXPECT_GE(closest_pair(picked), 4);
}

// Blocks of random brightness, slightly blurred.
cv::Mat blocks(int width, int height, std::uint64_t seed) {
  cv::Mat image(height, width, CV_8U);
  const RandomStream random(seed);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(
          random.below(static_cast<std::uint64_t>((y / 9) * 1000 + x / 9), 256));
  cv::GaussianBlur(image, image, {5, 5}, 0.8);
  return image;
}

void expect_equal_to_opencv(const cv::Mat& image, int edge_px, int threshold) {
  std::vector<cv::KeyPoint> all;
  cv::FAST(image, all, threshold, true);
  std::vector<Corner> expected;
  const cv::Rect area(edge_px, edge_px, image.cols - 2 * edge_px, image.rows - 2 * edge_px);
  for (const cv::KeyPoint& k : all)
    if (area.contains(k.pt))
      expected.push_back({.x = static_cast<std::int16_t>(k.pt.x),
                          .y = static_cast<std::int16_t>(k.pt.y),
                          .strength = static_cast<std::int16_t>(k.response)});
  EXPECT_EQ(fast_corners(image, edge_px, threshold), expected) << threshold;
  EXPECT_GT(expected.size(), 10U);
}

TEST(FastCorners, EqualThoseOfOpenCv) {
  const cv::Mat image = blocks(640, 480, 3);
  for (const int threshold : {1, 7, 20, 60}) expect_equal_to_opencv(image, 19, threshold);
  // Widths that are not a multiple of a SIMD register, and windows of a larger image.
  for (const int width : {71, 96, 127, 130}) {
    expect_equal_to_opencv(image(cv::Rect(11, 5, width, 90)), 4, 10);
    expect_equal_to_opencv(image(cv::Rect(11, 5, width, 90)).clone(), 4, 10);
  }
  // Narrower than a register, so processed pixel by pixel. With 38 columns, 30 are searched and 32
  // are filled.
  for (const int width : {14, 20, 31, 37, 38, 39})
    expect_equal_to_opencv(image(cv::Rect(11, 5, width, 300)), 4, 10);
}

TEST(FastCorners, KnowsBlackFromWhite) {
  // The extremes of contrast: bright on dark and dark on bright.
  cv::Mat image(60, 60, CV_8U, cv::Scalar(0));
  image.at<std::uint8_t>(20, 20) = 255;
  image(cv::Rect(30, 0, 30, 60)).setTo(255);
  image.at<std::uint8_t>(20, 45) = 0;
  const std::vector<Corner> expected = {{.x = 20, .y = 20, .strength = 254},
                                        {.x = 45, .y = 20, .strength = 254}};
  EXPECT_EQ(fast_corners(image, 4, 200), expected);
}

TEST(FastCorners, ImagesThatHoldOnlyBorderHaveNone) {
  EXPECT_TRUE(fast_corners(blocks(38, 90, 1), 19, 7).empty());
  EXPECT_TRUE(fast_corners(blocks(90, 20, 1), 19, 7).empty());
}

TEST(FindCorners, LowThresholdServesExactlyTheCellsWithoutStrongCorners) {
  cv::Mat image = blocks(640, 480, 4);
  // The right half has an eighth of its contrast.
  cv::Mat right = image(cv::Rect(320, 0, 320, 480));
  right.convertTo(right, CV_8U, 0.12, 100);
  const std::vector<Corner> corners = find_corners(image, 19, 20, 7);
  const std::vector<Corner> strong = find_corners(image, 19, 20, 20);
  EXPECT_TRUE(std::is_sorted(corners.begin(), corners.end(), stronger));
  EXPECT_TRUE(
      std::includes(corners.begin(), corners.end(), strong.begin(), strong.end(), stronger));
  std::size_t strong_left = 0, weak_left = 0, weak_right = 0;
  for (const Corner& c : corners) {
    EXPECT_GE(c.strength, 7);
    strong_left += c.x < 280 && c.strength >= 20;
    weak_left += c.x < 280 && c.strength < 20;
    weak_right += c.x > 360 && c.strength < 20;
  }
  EXPECT_GT(strong_left, 300U);
  EXPECT_EQ(weak_left, 0U);
  EXPECT_GT(weak_right, 300U);
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
