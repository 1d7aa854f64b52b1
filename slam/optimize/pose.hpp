// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/config/pose.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/core/se3.hpp"
#include "slam/optimize/reprojection.hpp"

namespace mh {

/// A landmark seen in the image. Residual: (u, v) and, if depth is known, the pseudo-disparity d =
/// fx * baseline / z (Camera::disparity_px), all divided by sigma.
struct PoseObservation {
  Eigen::Vector3d point_in_world;
  double u_px = 0, v_px = 0;
  double disparity_px = -1;  ///< negative = no depth
  double sigma_px = 1;       ///< standard deviation of the keypoint (scale^octave)

  ImageMeasurement measurement() const {
    return {.u_px = u_px, .v_px = v_px, .disparity_px = disparity_px, .sigma_px = sigma_px};
  }
};

struct PoseEstimate {
  SE3 camera_from_world;
  std::vector<std::uint8_t> inlier;  ///< one per observation
  int inlier_count = 0;
  /// Inverse covariance of a left perturbation (translation, rotation; of the camera, in its own
  /// frame), from the inliers' residuals alone: distortions of the map itself are not included.
  Matrix6d information = Matrix6d::Zero();
};

/// Robust minimization of the reprojection error: argmin over T of sum rho(|pi(T X_i) - u_i|^2 /
/// sigma_i^2), Huber rho in the first half of the rounds, left perturbation T <- exp(delta) T,
/// analytic Jacobians.
/// @returns nullopt with fewer than config.min_inliers inliers, or if the normal equations are
/// singular.
std::optional<PoseEstimate> estimate_pose(std::span<const PoseObservation> observations,
                                          const SE3& camera_from_world_guess, const Camera& camera,
                                          const PoseConfig& config = {});

/// Classifies each observation at a pose by the chi-square gates; points behind the camera (z < 1
/// cm) fail. Writes one flag per observation (the vector is reused). @returns the number that pass.
int find_inliers(std::span<const PoseObservation> observations, const SE3& camera_from_world,
                 const Camera& camera, const PoseConfig& config, std::vector<std::uint8_t>& inlier);

/// Pose without an initial guess: P3P (OpenCV's AP3P) on random triples inside RANSAC, inliers by
/// the chi-square gates of `pose`, refined with its rounds and iterations. Draws depend only on the
/// stream.
/// @returns the best consensus; nullopt if it has fewer than config.min_inliers inliers.
std::optional<PoseEstimate> solve_pnp_ransac(std::span<const PoseObservation> observations,
                                             const Camera& camera, const RansacConfig& config,
                                             const PoseConfig& pose, RandomStream stream);

}  // namespace mh
