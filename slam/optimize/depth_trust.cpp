// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/depth_trust.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "slam/optimize/reprojection.hpp"

namespace mh {
namespace {

constexpr int kLeastDepths = 30;
constexpr double kQuartile = 0.25;
/// Three motions change depths: along the optical axis and about the two other axes.
constexpr int kDirections = 3;
constexpr double kQuartileChi2 =
    1.2125;  // lower quartile of chi-square with kDirections degrees of freedom
/// A direction is undetermined if the depths give it less than this share of the information that
/// they give the best direction.
constexpr double kLeastInformation = 1e-9;

}  // namespace

std::optional<double> depth_disagreement(std::span<const PoseObservation> observations,
                                         const SE3& camera_from_world, const Camera& camera) {
  Matrix6d of_depth = Matrix6d::Zero(), of_all = Matrix6d::Zero();
  Vector6d pull = Vector6d::Zero();
  int depths = 0;
  for (const PoseObservation& o : observations) {
    const Eigen::Vector3d p = camera_from_world * o.point_in_world;
    if (p.z() < kMinimumDepth_m) continue;
    const ImageMeasurement measured = o.measurement();
    const Eigen::Matrix<double, 3, 6> jacobian =
        reprojection_jacobian(p, measured, camera) * perturbation_jacobian(p);
    of_all.noalias() += jacobian.transpose() * jacobian;
    if (!measured.has_depth()) continue;
    ++depths;
    of_depth.noalias() += jacobian.row(2).transpose() * jacobian.row(2);
    pull += jacobian.row(2).transpose() * reprojection_residual(p, measured, camera).z();
  }
  if (depths < kLeastDepths) return std::nullopt;
  const Matrix6d covariance = of_depth - of_depth * of_all.ldlt().solve(of_depth);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> axes(covariance);
  const Vector6d along = axes.eigenvectors().transpose() * pull;
  const double least = kLeastInformation * axes.eigenvalues().maxCoeff();
  double chi2 = 0;
  int directions = 0;
  for (int i = 0; i < 6; ++i) {
    if (!(axes.eigenvalues()[i] > least)) continue;
    chi2 += along[i] * along[i] / axes.eigenvalues()[i];
    ++directions;
  }
  if (directions != kDirections) return std::nullopt;
  return chi2 / kQuartileChi2;
}

double learned_disparity_sigma_px(double disparity_sigma_px, int frames, double disagreement) {
  // The sum of the steps grows without bound, but the sum of their squares does not. The first
  // steps are large enough to cross the range in a few hundred frames.
  constexpr double kGain = 8, kFirstFrames = 20;
  constexpr double kLeast_px = 0.03, kMost_px = 10;
  const double step = kGain / (frames + kFirstFrames);
  const double by = disagreement > 1 ? kQuartile * step : (kQuartile - 1) * step;
  return std::clamp(disparity_sigma_px * std::exp(by), kLeast_px, kMost_px);
}

}  // namespace mh
