// SPDX-License-Identifier: Apache-2.0
#include "slam/track/rolling_shutter.hpp"

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

constexpr double kReadout_s = 0.0261;

/// The velocity of a camera that turns at 1.5 rad/s and moves at 0.5 m/s.
Vector6d velocity() {
  Vector6d twist;
  twist << 0.3, -0.2, 0.35, 0.9, 1.1, -0.4;
  return twist;
}

/// The keypoint of a point (in the camera at the timestamp) whose row is read out while the camera
/// moves, found by iterating between row and time.
Keypoint rolled(const Camera& camera, const Eigen::Vector3d& point) {
  double after_s = 0;
  Eigen::Vector3d seen = point;
  for (int i = 0; i < 20; ++i) {
    seen = SE3::exp(after_s * velocity()) * point;
    after_s = ((camera.project(seen).y() + 0.5) / camera.height_px - 0.5) * kReadout_s;
  }
  Keypoint keypoint;
  keypoint.u_px = static_cast<float>(camera.project(seen).x());
  keypoint.v_px = static_cast<float>(camera.project(seen).y());
  keypoint.depth_m = static_cast<float>(seen.z());
  return keypoint;
}

TEST(Straighten, PutsPointsWhereTheStampSawThem) {
  const Camera camera;
  double farthest_px = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const RandomStream s = RandomStream(1).fork(i);
    const double u_px = s.uniform(0, 0, camera.width_px - 1),
                 v_px = s.uniform(1, 0, camera.height_px - 1), depth_m = s.uniform(2, 0.6, 5);
    Keypoint k = rolled(camera, camera.unproject(u_px, v_px, depth_m));
    farthest_px = std::max(farthest_px, std::hypot(k.u_px - u_px, k.v_px - v_px));
    straighten({&k, 1}, camera, velocity(), kReadout_s);
    EXPECT_NEAR(k.u_px, u_px, 1e-3);
    EXPECT_NEAR(k.v_px, v_px, 1e-3);
    EXPECT_NEAR(k.depth_m, depth_m, 1e-5);
  }
  EXPECT_GT(farthest_px, 8.0);  // there was something to correct
}

TEST(Straighten, WithoutDepthTheTurnAloneIsKnown) {
  const Camera camera;
  Keypoint k =
      rolled(camera, camera.unproject(500, 450, 1e4));  // so far away that shifting has no effect
  k.depth_m = 0;
  straighten({&k, 1}, camera, velocity(), kReadout_s);
  EXPECT_NEAR(k.u_px, 500, 0.01);
  EXPECT_NEAR(k.v_px, 450, 0.01);
  EXPECT_EQ(k.depth_m, 0);
}

TEST(Straighten, AGlobalShutterOrACameraAtRestKeepsThem) {
  Keypoint k;
  k.u_px = 17.3F, k.v_px = 411.7F, k.depth_m = 1.234F;
  const Keypoint before = k;
  straighten({&k, 1}, Camera{}, velocity(), 0);
  EXPECT_EQ(k.u_px, before.u_px);
  EXPECT_EQ(k.v_px, before.v_px);
  EXPECT_EQ(k.depth_m, before.depth_m);
  straighten({&k, 1}, Camera{}, Vector6d::Zero(), kReadout_s);
  EXPECT_NEAR(k.u_px, before.u_px, 1e-4);
  EXPECT_NEAR(k.v_px, before.v_px, 1e-4);
}

}  // namespace
}  // namespace mh
