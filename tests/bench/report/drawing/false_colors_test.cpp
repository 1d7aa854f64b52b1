// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/false_colors.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

TEST(ClassColor, AnyTwoClassesCanBeTold) {
  for (const ClassInfo& a : classes())
    for (const ClassInfo& b : classes())
      if (a.id < b.id) {
        EXPECT_GT(color_distance(class_color(a.id), class_color(b.id)), 20)
            << a.name << " and " << b.name;
      }
}

TEST(ColorDistance, IsThatOfCieLab) {
  EXPECT_NEAR(color_distance({255, 255, 255}, {0, 0, 0}), 100, 0.1);
  EXPECT_EQ(color_distance({9, 8, 7}, {9, 8, 7}), 0);
  // The corners of sRGB in CIELAB under D65: red (53.24, 80.09, 67.20), green (87.73, -86.18,
  // 83.18), blue (32.30, 79.19, -107.86); a middle gray (53.59, 0, 0).
  EXPECT_NEAR(color_distance({255, 0, 0}, {0, 0, 0}), 117.3, 0.2);
  EXPECT_NEAR(color_distance({0, 255, 0}, {0, 0, 0}), 148.5, 0.2);
  EXPECT_NEAR(color_distance({0, 0, 255}, {0, 0, 0}), 137.7, 0.2);
  EXPECT_NEAR(color_distance({255, 0, 0}, {0, 255, 0}), 170.6, 0.2);
  EXPECT_NEAR(color_distance({255, 0, 0}, {0, 0, 255}), 176.3, 0.2);
  EXPECT_NEAR(color_distance({128, 128, 128}, {0, 0, 0}), 53.59, 0.05);
  EXPECT_NEAR(color_distance({10, 10, 10}, {0, 0, 0}), 2.74, 0.02) << "the straight part";
}

TEST(DepthColors, WhatDidNotReturnIsLikeNothingThatDidAndNotVoid) {
  Grid2d<float> depth_m(101, 1);
  for (int x = 0; x < 101; ++x) depth_m(x, 0) = 0.1F * static_cast<float>(x);
  const cv::Mat image = depth_colors(depth_m, 0.4F, 8.0F);
  const auto at = [&](int x) {
    const cv::Vec3b bgr = image.at<cv::Vec3b>(0, x);
    return Rgb8{bgr[2], bgr[1], bgr[0]};
  };
  for (int x = 1; x < 101; ++x) EXPECT_GT(color_distance(at(x), at(0)), 40) << depth_m(x, 0);
  EXPECT_GT(color_distance(at(0), class_color(kVoid)), 45) << "nobody knows the class";
  EXPECT_GT(color_distance(at(4), at(80)), 60) << "near and far";
}

}  // namespace
}  // namespace mh
