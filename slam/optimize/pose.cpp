// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/pose.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "slam/optimize/reprojection.hpp"

namespace mh {
namespace {

/// A step that lowers the cost by a smaller share than this moves the pose by far less than the
/// noise.
constexpr double kRelativeDecrease = 1e-6;
/// Below this ratio of pivots, the pose is undetermined: a regular view gives about 1e-5, a rank
/// deficiency only rounding errors, about 1e-16.
constexpr double kSingularPivotRatio = 1e-12;

struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double cost = 0;
};

double gate(const ImageMeasurement& measured, const PoseConfig& config) {
  return measured.has_depth() ? config.chi2_stereo : config.chi2_mono;
}

/// Normal equations and cost over the inliers at a pose.
NormalEquations linearize(std::span<const PoseObservation> observations,
                          std::span<const std::uint8_t> inlier, const SE3& camera_from_world,
                          const Camera& camera, const PoseConfig& config, bool robust) {
  Eigen::Matrix3d upper_left = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d lower_left = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d lower_right = Eigen::Matrix3d::Zero();
  NormalEquations sum;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!inlier[i]) continue;
    const ImageMeasurement measured = observations[i].measurement();
    const double limit = gate(measured, config);
    const Eigen::Vector3d p = camera_from_world * observations[i].point_in_world;
    if (p.z() < kMinimumDepth_m) {
      sum.cost += robust ? huber_loss(kBehindChi2, limit) : kBehindChi2;
      continue;
    }
    const Eigen::Vector3d r = reprojection_residual(p, measured, camera);
    const double chi2 = r.squaredNorm();
    sum.cost += robust ? huber_loss(chi2, limit) : chi2;
    const double weight = robust ? huber_weight(chi2, limit) : 1.0;
    const CameraFrameTerm term = camera_frame_term(p, r, weight, measured, camera);
    // [I | -hat(p)]^T M [I | -hat(p)], block by block.
    const Eigen::Matrix3d turned = cross_columns(p, term.information);
    upper_left += term.information;
    lower_left += turned;
    lower_right += cross_columns(p, turned.transpose());
    sum.gradient.head<3>() += term.gradient;
    sum.gradient.tail<3>() += p.cross(term.gradient);
  }
  sum.hessian << upper_left, lower_left.transpose(), lower_left, lower_right;
  return sum;
}

bool is_singular(const Matrix6d& hessian) {
  const Eigen::LDLT<Matrix6d> factor(hessian);
  const Vector6d pivots = factor.vectorD();
  return factor.info() != Eigen::Success ||
         !(pivots.minCoeff() > kSingularPivotRatio * pivots.maxCoeff());
}

/// Levenberg-Marquardt over a fixed inlier set. @returns the matrix of the normal equations, or
/// nullopt if the pose is undetermined.
std::optional<Matrix6d> minimize(std::span<const PoseObservation> observations,
                                 std::span<const std::uint8_t> inlier, const Camera& camera,
                                 const PoseConfig& config, bool robust, SE3& camera_from_world) {
  // Nearly Gauss-Newton; the damping matters only after a step has failed.
  double damping = 1e-9;
  NormalEquations at_pose =
      linearize(observations, inlier, camera_from_world, camera, config, robust);
  if (is_singular(at_pose.hessian)) return std::nullopt;
  for (int iteration = 0; iteration < config.iterations; ++iteration) {
    Matrix6d damped = at_pose.hessian;
    damped.diagonal() *= 1.0 + damping;
    const Vector6d step = -damped.ldlt().solve(at_pose.gradient);
    if (!step.allFinite()) return std::nullopt;
    const SE3 trial = SE3::exp(step) * camera_from_world;
    // To first order, the step lowers the cost by -gradient . step: if that is negligible, take it
    // without evaluating its result.
    if (-at_pose.gradient.dot(step) <= kRelativeDecrease * at_pose.cost) {
      camera_from_world = trial;
      break;
    }
    const NormalEquations at_trial = linearize(observations, inlier, trial, camera, config, robust);
    if (at_trial.cost > at_pose.cost) {
      damping = std::max(damping * 100.0, 1e-4);
      continue;
    }
    camera_from_world = trial;
    at_pose = at_trial;
    damping = std::max(damping * 0.1, 1e-9);
    if (at_pose.cost <= kPerfectChi2 * static_cast<double>(observations.size())) break;
  }
  if (is_singular(at_pose.hessian)) return std::nullopt;
  return at_pose.hessian;
}

}  // namespace

int find_inliers(std::span<const PoseObservation> observations, const SE3& camera_from_world,
                 const Camera& camera, const PoseConfig& config,
                 std::vector<std::uint8_t>& inlier) {
  inlier.resize(observations.size());
  int count = 0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const ImageMeasurement measured = observations[i].measurement();
    const Eigen::Vector3d p = camera_from_world * observations[i].point_in_world;
    const bool fits =
        p.z() >= kMinimumDepth_m &&
        reprojection_residual(p, measured, camera).squaredNorm() <= gate(measured, config);
    inlier[i] = fits;
    count += fits;
  }
  return count;
}

std::optional<PoseEstimate> estimate_pose(std::span<const PoseObservation> observations,
                                          const SE3& camera_from_world_guess, const Camera& camera,
                                          const PoseConfig& config) {
  // Three points are the minimum that determines a pose, even if the caller would accept fewer.
  const int needed = std::max(config.min_inliers, 3);
  if (static_cast<int>(observations.size()) < needed) return std::nullopt;

  SE3 pose = camera_from_world_guess;
  std::vector<std::uint8_t> inlier(observations.size());
  for (std::size_t i = 0; i < observations.size(); ++i)
    inlier[i] = (pose * observations[i].point_in_world).z() >= kMinimumDepth_m;

  int count = 0;
  Matrix6d information;
  std::vector<std::uint8_t> regrouped;
  for (int round = 0; round < config.rounds; ++round) {
    const bool robust = 2 * round < config.rounds;
    const auto matrix = minimize(observations, inlier, camera, config, robust, pose);
    if (!matrix) return std::nullopt;
    information = *matrix;
    count = find_inliers(observations, pose, camera, config, regrouped);
    if (count < 3) return std::nullopt;
    const bool unchanged = regrouped == inlier;
    inlier.swap(regrouped);
    // Without Huber's loss, the same inliers give the same minimum, so further rounds change
    // nothing.
    if (unchanged && !robust) break;
  }
  if (count < needed) return std::nullopt;
  return PoseEstimate{.camera_from_world = pose.normalized(),
                      .inlier = std::move(inlier),
                      .inlier_count = count,
                      .information = information};
}

}  // namespace mh
