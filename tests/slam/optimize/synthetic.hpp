// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/core/se3.hpp"
#include "slam/optimize/pose.hpp"
#include "slam/optimize/reprojection.hpp"

namespace mh::testing {

inline Vector6d tangent(double x, double y, double z, double rx, double ry, double rz) {
  Vector6d v;
  v << x, y, z, rx, ry, rz;
  return v;
}

/// Standard deviation (px) that the residual assigns to the disparity of a keypoint with sigma 1.
inline double disparity_sigma_px(const Camera& camera) {
  const double disparity = camera.disparity_px(2.0);
  const ImageMeasurement off{
      .u_px = camera.cx_px, .v_px = camera.cy_px, .disparity_px = disparity - 1.0};
  return 1.0 / reprojection_residual({0, 0, 2}, off, camera).z();
}

/// A pose far from the identity.
inline SE3 true_pose() {
  return SE3::exp(tangent(0.7, -1.1, 0.4, 0.3, -0.9, 0.5));
}

/// A pose 10 cm and 5 degrees away from `pose`.
inline SE3 ten_centimeters_and_five_degrees(const SE3& pose) {
  const double angle = 5.0 * std::numbers::pi / 180.0;
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  const Eigen::Vector3d shift = 0.1 * Eigen::Vector3d(2, 1, -2).normalized();
  return SE3(so3_exp(angle * axis), shift) * pose;
}

/// Points spread over the image at depths of 1 to 5 m, seen without noise; every third without
/// depth, standard deviations of 1 to 2 px.
inline std::vector<PoseObservation> observe(int count, const SE3& camera_from_world,
                                            const Camera& camera, RandomStream stream) {
  std::vector<PoseObservation> observations;
  const SE3 world_from_camera = camera_from_world.inverse();
  for (int i = 0; i < count; ++i) {
    const RandomStream s = stream.fork(static_cast<std::uint64_t>(i));
    const double u = s.uniform(0, 0, camera.width_px - 1);
    const double v = s.uniform(1, 0, camera.height_px - 1);
    const double z = s.uniform(2, 1.0, 5.0);
    PoseObservation o{.point_in_world = world_from_camera * camera.unproject(u, v, z),
                      .u_px = u,
                      .v_px = v,
                      .sigma_px = s.uniform(3, 1.0, 2.0)};
    if (i % 3 != 0) o.disparity_px = camera.disparity_px(z);
    observations.push_back(o);
  }
  return observations;
}

/// Gaussian noise of the stated standard deviation on every measurement.
inline void add_noise(std::vector<PoseObservation>& observations, const Camera& camera,
                      RandomStream stream) {
  for (std::size_t i = 0; i < observations.size(); ++i) {
    PoseObservation& o = observations[i];
    const RandomStream s = stream.fork(i);
    o.u_px += o.sigma_px * s.normal(0);
    o.v_px += o.sigma_px * s.normal(1);
    if (o.disparity_px >= 0)
      o.disparity_px += disparity_sigma_px(camera) * o.sigma_px * s.normal(2);
  }
}

/// Replaces the pixel (not the depth) of the first `count` observations by one at least 50 px off.
inline void make_outliers(std::vector<PoseObservation>& observations, int count,
                          const Camera& camera, RandomStream stream) {
  for (int i = 0; i < count; ++i) {
    PoseObservation& o = observations[static_cast<std::size_t>(i)];
    const RandomStream s = stream.fork(static_cast<std::uint64_t>(i));
    const double u = s.uniform(0, 0, camera.width_px - 1);
    const double v = s.uniform(1, 0, camera.height_px - 1);
    const double off = std::hypot(u - o.u_px, v - o.v_px);
    o.u_px = off < 50 ? o.u_px + 60 : u;
    o.v_px = off < 50 ? o.v_px - 60 : v;
  }
}

inline double distance_m(const SE3& a, const SE3& b) {
  return (a.inverse().translation() - b.inverse().translation()).norm();
}

}  // namespace mh::testing
