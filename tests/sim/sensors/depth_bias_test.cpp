// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/depth_bias.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace mh {
namespace {

Grid2d<float> plane(float depth_m) {
  Grid2d<float> depth(64, 48);
  std::fill(depth.begin(), depth.end(), depth_m);
  return depth;
}

TEST(DepthBias, IsNeutralUnlessItIsSetAndKeepsHoles) {
  Grid2d<float> depth = plane(2.3F);
  depth(5, 6) = 0;
  EXPECT_TRUE(std::ranges::equal(biased_depth(depth, {.enabled = true}), depth));
  const Grid2d<float> all =
      biased_depth(depth, {.enabled = true, .scale = 1.035, .bend = 0.01, .shift_x_px = 1});
  EXPECT_EQ(all(4, 6), 0);
}

TEST(DepthBias, ScaleIsAFactor) {
  const Grid2d<float> scaled = biased_depth(plane(2.0F), {.enabled = true, .scale = 1.035});
  for (const float z : scaled) EXPECT_FLOAT_EQ(z, 2.07F);
}

// The mean of f^2 is taken over the image and over the two ends of distance, s = -1 and s = 1.
TEST(DepthBias, BendIsTheRootMeanSquareOverImageAndDistance) {
  for (const std::uint64_t camera : {0, 1, 2}) {
    double squares = 0, sum = 0;
    for (const float z : {1e-6F, 1e6F})  // s = -1 and 1
      for (const float biased :
           biased_depth(plane(z), {.enabled = true, .bend = 0.01, .camera = camera})) {
        const double f = biased / z - 1.0;
        squares += f * f;
        sum += f;
      }
    EXPECT_NEAR(std::sqrt(squares / (2 * 64 * 48)), 0.01, 1e-5) << camera;
    EXPECT_NEAR(sum / (2 * 64 * 48), 0, 0.01) << camera;
  }
}

TEST(DepthBias, IsSmoothAndOfOneCamera) {
  const DepthBiasConfig config{.enabled = true, .bend = 0.01};
  const Grid2d<float> biased = biased_depth(plane(1.0F), config);
  for (int y = 0; y < 48; ++y)
    for (int x = 1; x < 64; ++x) EXPECT_NEAR(biased(x, y), biased(x - 1, y), 0.003);
  EXPECT_TRUE(std::ranges::equal(biased, biased_depth(plane(1.0F), config)));
  EXPECT_FALSE(std::ranges::equal(
      biased, biased_depth(plane(1.0F), {.enabled = true, .bend = 0.01, .camera = 1})));
  const Grid2d<float> farther = biased_depth(plane(3.0F), config);
  EXPECT_GT(std::abs(farther(10, 10) / 3.0F - biased(10, 10)), 1e-4);
}

TEST(DepthBias, ShiftReadsBesideThePixel) {
  Grid2d<float> depth = plane(1.0F);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) depth(x, y) = 1.0F + 0.01F * static_cast<float>(x + 64 * y);
  const Grid2d<float> moved =
      biased_depth(depth, {.enabled = true, .shift_x_px = 2, .shift_y_px = -1});
  EXPECT_EQ(moved(10, 20), depth(12, 19));
  EXPECT_EQ(moved(62, 20), 0);
  EXPECT_EQ(moved(10, 0), 0);
}

}  // namespace
}  // namespace mh
