// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/registered_depth.hpp"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace mh {
namespace {

Camera camera_of(int width_px, int height_px, double focal_px) {
  Camera camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fx_px = camera.fy_px = focal_px;
  camera.cx_px = 0.5 * (width_px - 1);
  camera.cy_px = 0.5 * (height_px - 1);
  return camera;
}

TEST(RegisteredDepth, OfSeveralPointsTheNearestStays) {
  // With the depth camera 0.25 m to the side, a point at z m moves by 1 / z pixels.
  const DepthCamera depth{camera_of(4, 1, 4), {Eigen::Matrix3d::Identity(), {0.25, 0, 0}}};
  Grid2d<float> depth_m(4, 1);
  depth_m(0, 0) = 0.5F;  // to pixel 2
  depth_m(1, 0) = 1;     // to pixel 2 as well
  depth_m(2, 0) = 1;     // to pixel 3
  const Grid2d<float> registered = registered_depth(depth_m, depth, camera_of(4, 1, 4));
  EXPECT_EQ(registered(0, 0), 0);
  EXPECT_EQ(registered(1, 0), 0);
  EXPECT_EQ(registered(2, 0), 0.5F);
  EXPECT_EQ(registered(3, 0), 1);
}

TEST(RegisteredDepth, GoesThroughBothLenses) {
  DepthCamera depth{camera_of(160, 120, 100), {}};
  depth.camera.distortion = {0.4, 0.01, 0, 0, -0.008, 0.75, 0.02, -0.03};
  Camera color = camera_of(320, 240, 100);
  color.distortion = {.k1 = -0.1, .k2 = 0.01, .p1 = 0.002};
  for (const auto& [x, y] : {std::pair(5, 7), {150, 20}, {80, 110}}) {
    Grid2d<float> depth_m(160, 120);
    depth_m(x, y) = 3;
    const Grid2d<float> registered = registered_depth(depth_m, depth, color);
    int met = 0;
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 320; ++u) {
        if (registered(u, v) == 0) continue;
        ++met;
        EXPECT_EQ(registered(u, v), 3);
        // Where the color pixel's ray appears in the depth image.
        const Eigen::Vector2d ray = color.distortion.undistorted((u - color.cx_px) / color.fx_px,
                                                                 (v - color.cy_px) / color.fy_px);
        const Eigen::Vector2d seen = depth.camera.distortion.distorted(ray.x(), ray.y());
        EXPECT_NEAR(100 * seen.x() + depth.camera.cx_px, x, 0.7);
        EXPECT_NEAR(100 * seen.y() + depth.camera.cy_px, y, 0.7);
      }
    EXPECT_EQ(met, 1);
  }
}

// With k1 = -0.4, points up to 0.61 rad off the axis are shown; those farther out would be folded
// back toward the center.
TEST(RegisteredDepth, WhatALensWouldFoldIsLeftOut) {
  const DepthCamera wide{camera_of(201, 1, 50), {}};
  Grid2d<float> depth_m(201, 1, 1.0F);
  Camera color = camera_of(201, 1, 50);
  color.distortion.k1 = -0.4;
  const Grid2d<float> registered = registered_depth(depth_m, wide, color);
  const double end = std::sqrt(1 / (3 * 0.4)), reach_px = 50 * end * (1 - 0.4 * end * end);
  for (int u = 0; u < 201; ++u) EXPECT_EQ(registered(u, 0) > 0, std::abs(u - 100) < reach_px) << u;
}

}  // namespace
}  // namespace mh
