// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/optimize/bundle.hpp"
#include "tests/slam/optimize/synthetic.hpp"

namespace mh::testing {

struct BundleShape {
  std::uint32_t poses = 10;
  std::uint32_t fixed_poses = 1;
  std::uint32_t points = 1500;
  std::uint32_t observations_per_point = 4;
  double depth_share = 1.0;  ///< of the observations
  double noise_px = 1.0;     ///< as a multiple of sigma
  double disturbance_m =
      0.05;  ///< of the initial points and free poses; also of their angles, in rad
};

struct SyntheticBundle {
  BundleProblem problem;  ///< perturbed: the start of the adjustment
  std::vector<SE3> true_poses;
  std::vector<Eigen::Vector3d> true_points;
};

/// Cameras on an arc around a cloud of points 3 m away, all looking at it.
inline SyntheticBundle make_bundle(const BundleShape& shape, const Camera& camera,
                                   RandomStream stream) {
  SyntheticBundle bundle;
  for (std::uint32_t i = 0; i < shape.poses; ++i) {
    const double angle = 0.08 * static_cast<double>(i) - 0.3;
    const SE3 turn(so3_exp({0.1 * std::sin(3 * angle), angle, 0.05 * angle}),
                   Eigen::Vector3d::Zero());
    const SE3 retreat(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Eigen::Vector3d(0, 0, 3));
    bundle.true_poses.push_back(retreat * turn);
  }
  const RandomStream place = stream.fork(0);
  for (std::uint32_t i = 0; i < shape.points; ++i)
    bundle.true_points.emplace_back(place.uniform(3 * i, -1.0, 1.0),
                                    place.uniform(3 * i + 1, -0.8, 0.8),
                                    place.uniform(3 * i + 2, -1.0, 1.0));

  BundleProblem& problem = bundle.problem;
  problem.free_poses = shape.poses - shape.fixed_poses;
  const RandomStream noise = stream.fork(1);
  std::uint64_t draw = 0;
  for (std::uint32_t point = 0; point < shape.points; ++point) {
    for (std::uint32_t k = 0; k < std::min(shape.observations_per_point, shape.poses); ++k) {
      const std::uint32_t pose = (point * 7 + k) % shape.poses;
      const Eigen::Vector3d p = bundle.true_poses[pose] * bundle.true_points[point];
      BundleObservation o{.pose = pose, .point = point};
      o.sigma_px = static_cast<float>(noise.uniform(draw, 1.0, 2.0));
      const double scale = shape.noise_px * static_cast<double>(o.sigma_px);
      const Eigen::Vector2d pixel = camera.project(p);
      o.u_px = static_cast<float>(pixel.x() + scale * noise.normal(draw + 1));
      o.v_px = static_cast<float>(pixel.y() + scale * noise.normal(draw + 2));
      if (noise.uniform(draw + 3) < shape.depth_share)
        o.disparity_px =
            static_cast<float>(camera.disparity_px(p.z()) +
                               disparity_sigma_px(camera) * scale * noise.normal(draw + 4));
      draw += 5;
      problem.observations.push_back(o);
    }
  }

  const RandomStream shift = stream.fork(2);
  const auto off = [&](std::uint64_t index) {
    return shape.disturbance_m * shift.uniform(index, -1.0, 1.0);
  };
  problem.camera_from_world = bundle.true_poses;
  for (std::uint32_t i = 0; i < problem.free_poses; ++i) {
    Vector6d step;
    for (int k = 0; k < 6; ++k) step[k] = off(6 * i + static_cast<std::uint64_t>(k));
    problem.camera_from_world[i] = SE3::exp(step) * problem.camera_from_world[i];
  }
  problem.points_in_world = bundle.true_points;
  for (std::uint32_t i = 0; i < shape.points; ++i)
    for (int k = 0; k < 3; ++k)
      problem.points_in_world[i][k] += off(1'000'000 + 3 * i + static_cast<std::uint64_t>(k));
  return bundle;
}

}  // namespace mh::testing
