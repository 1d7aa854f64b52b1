// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/trajectory_score.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "bench/protocol/metrics/evaluate.hpp"

namespace mh {
namespace {

/// The RMSE; unknown, not 0, if there are no errors.
std::optional<double> rmse(const ErrorStatistics& s) {
  return s.count > 0 ? std::optional(s.rmse) : std::nullopt;
}

/// Whether the path extends far enough sideways from its main direction to determine the
/// alignment's rotation about that direction: position errors change the rotation by about error /
/// extent.
bool turn_is_determined(const Trajectory& truth, double error_m) {
  constexpr double kLeastExtent = 10;  // in multiples of the error: a rotation error of 0.1 rad
  Eigen::MatrixX3d at(static_cast<Eigen::Index>(truth.size()), 3);
  for (std::size_t i = 0; i < truth.size(); ++i)
    at.row(static_cast<Eigen::Index>(i)) = truth[i].world_from_camera.translation();
  const Eigen::Matrix3d scatter =
      (at.rowwise() - at.colwise().mean()).transpose() * (at.rowwise() - at.colwise().mean());
  const Eigen::Vector3d squares =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter / static_cast<double>(truth.size()))
          .eigenvalues();  // ascending
  return std::sqrt(std::max(0.0, squares[1])) >= kLeastExtent * error_m;
}

}  // namespace

TrajectoryScore score_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                 std::size_t offered) {
  const Evaluation e = evaluate(truth, estimate);
  TrajectoryScore score;
  score.offered = static_cast<double>(offered);
  score.tracked = static_cast<double>(estimate.size());
  score.scored = static_cast<double>(e.pairs);
  score.completeness = offered == 0 ? 0 : score.tracked / score.offered;
  score.in_any_map = score.completeness;
  score.ate_rmse_m = rmse(e.ape_translation_m);
  if (score.ate_rmse_m) score.ate_median_m = e.ape_translation_m.median;
  if (score.ate_rmse_m &&
      turn_is_determined(match_by_stamp(truth, estimate).truth, *score.ate_rmse_m))
    score.ate_rmse_deg = rmse(e.ape_rotation_deg);
  score.rpe_frame_rmse_m = rmse(e.rpe[0].translation_m);
  score.rpe_second_rmse_m = rmse(e.rpe[1].translation_m);
  // One pose aligned with itself has no meaningful error.
  if (e.pairs > 1)
    score.ate_first_pose_m = rmse(ape_translation(truth, estimate, Alignment::kOrigin));
  return score;
}

EstimateAlignment align_estimate(const Trajectory& estimate, const Trajectory& truth) {
  EstimateAlignment alignment;
  const MatchedTrajectories matched = match_by_stamp(truth, estimate);
  if (matched.size() == 0) return alignment;
  alignment.dock_from_estimate = matched.truth.front().world_from_camera *
                                 matched.estimate.front().world_from_camera.inverse();
  const std::optional<Similarity> aligned = align(matched, Alignment::kSe3);
  alignment.truth_from_estimate =
      aligned ? SE3(aligned->rotation, aligned->translation_m) : alignment.dock_from_estimate;
  return alignment;
}

}  // namespace mh
