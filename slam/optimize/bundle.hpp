// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "slam/config/bundle.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/se3.hpp"

namespace mh {

struct BundleObservation {
  std::uint32_t pose = 0;   ///< index into BundleProblem::camera_from_world
  std::uint32_t point = 0;  ///< index into BundleProblem::points_in_world
  float u_px = 0, v_px = 0;
  float disparity_px = -1;  ///< negative = no depth
  float sigma_px = 1;
};

/// A motion between two poses that another sensor measured. Residual: log(b_from_a measured^-1),
/// divided by its standard deviations; weighted by Huber's rho, since wheels slip.
struct BundleMotion {
  std::uint32_t a = 0, b = 0;  ///< indices into BundleProblem::camera_from_world
  SE3 b_from_a;
  double sigma_m = 1, sigma_rad = 1;
};

/// Poses [0, free_poses) are adjusted, the rest are fixed. Observations are ordered by point.
struct BundleProblem {
  std::vector<SE3> camera_from_world;
  std::uint32_t free_poses = 0;
  std::vector<Eigen::Vector3d> points_in_world;
  std::vector<BundleObservation> observations;
  std::vector<BundleMotion> motions = {};
};

struct BundleResult {
  std::vector<SE3> camera_from_world;  ///< all, fixed ones unchanged
  std::vector<Eigen::Vector3d> points_in_world;
  std::vector<std::uint8_t> outlier;  ///< per observation: beyond its gate or behind the camera
  double initial_cost = 0;  ///< sum of Huber's rho over all observations; motions not included
  double final_cost =
      0;  ///< sum of squared whitened residuals over the inliers; motions are not included
  int iterations = 0;  ///< trial steps of both phases
};

/// Bundle adjustment by Levenberg-Marquardt with the Schur complement over points, analytic
/// Jacobians (Triggs et al., "Bundle adjustment: a modern synthesis", 1999); residuals as in
/// PoseObservation. Single-threaded; sums in input order.
///
/// Observations of points behind their camera are ignored (a step that moves a point there is
/// penalized). A point that its observations do not determine (one, without depth) stays fixed and
/// its observation is ignored; a pose without observations stays fixed, too.
/// @pre indices within range, observations ordered by point (asserted).
BundleResult adjust(const BundleProblem& problem, const Camera& camera,
                    const BundleConfig& config = {});

}  // namespace mh
