// SPDX-License-Identifier: Apache-2.0
#include "bench/results/trajectory_score.hpp"

#include <algorithm>

#include "bench/metrics/evaluate.hpp"

namespace mh {
namespace {

/// First matched pose onto the truth.
SE3 dock(const MatchedTrajectories& matched) {
  if (matched.size() == 0) return {};
  return matched.truth.front().world_from_camera *
         matched.estimate.front().world_from_camera.inverse();
}

/// A root mean square of no errors is unknown, not 0.
std::optional<double> rmse(const ErrorStatistics& s) {
  return s.count > 0 ? std::optional(s.rmse) : std::nullopt;
}

}  // namespace

TrajectoryScore score_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                 std::size_t offered) {
  const Evaluation e = evaluate(truth, estimate);
  TrajectoryScore score;
  score.offered = offered;
  score.tracked = estimate.size();
  score.completeness =
      offered == 0 ? 0 : static_cast<double>(estimate.size()) / static_cast<double>(offered);
  score.ate_rmse_m = rmse(e.ape_translation_m);
  score.rpe_frame_rmse_m = rmse(e.rpe[0].translation_m);
  score.rpe_second_rmse_m = rmse(e.rpe[1].translation_m);
  score.dock_from_estimate = dock(match_by_stamp(truth, estimate));
  // One pose laid over itself has no error to tell of.
  if (e.pairs > 1)
    score.ate_first_pose_m = rmse(ape_translation(truth, estimate, Alignment::kOrigin));
  // A path that determines no alignment (too short, on a line) is laid over by its first pose.
  score.truth_from_estimate = e.truth_from_estimate ? SE3(e.truth_from_estimate->rotation,
                                                          e.truth_from_estimate->translation_m)
                                                    : score.dock_from_estimate;
  return score;
}

}  // namespace mh
