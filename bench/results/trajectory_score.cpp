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

}  // namespace

TrajectoryScore score_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                 std::size_t offered) {
  const Evaluation e = evaluate(truth, estimate);
  TrajectoryScore score;
  score.offered = offered;
  score.tracked = estimate.size();
  score.completeness =
      offered == 0 ? 0 : static_cast<double>(estimate.size()) / static_cast<double>(offered);
  score.ate_rmse_m = e.ape_translation_m.rmse;
  score.rpe_frame_rmse_m = e.rpe[0].translation_m.rmse;
  score.rpe_second_rmse_m = e.rpe[1].translation_m.rmse;
  score.dock_from_estimate = dock(match_by_stamp(truth, estimate));
  score.ate_unaligned_m = ape_translation(truth, estimate, Alignment::kOrigin).rmse;
  // A path that determines no alignment (too short, on a line) is laid over by its first pose.
  score.truth_from_estimate = e.truth_from_estimate ? SE3(e.truth_from_estimate->rotation,
                                                          e.truth_from_estimate->translation_m)
                                                    : score.dock_from_estimate;
  return score;
}

}  // namespace mh
