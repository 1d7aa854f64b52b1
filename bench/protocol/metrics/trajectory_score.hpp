// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/protocol/metrics/metric.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// Quality of a mapping tour's trajectory. An error is absent if the path does not determine it
/// because it is too short or straight.
struct TrajectoryScore {
  double offered = 0;                ///< frames
  double tracked = 0;                ///< frames that have a pose in the largest map at the end
  double scored = 0;                 ///< tracked frames with a true pose: ATE is computed over them
  std::optional<double> ate_rmse_m;  ///< after SE(3) alignment without scale
  std::optional<double> ate_median_m;       ///< median of the same errors
  std::optional<double> ate_rmse_deg;       ///< of orientations, after the same alignment
  std::optional<double> ate_first_pose_m;   ///< in the frame of dock_from_estimate
  std::optional<double> rpe_frame_rmse_m;   ///< translation error per frame step
  std::optional<double> rpe_second_rmse_m;  ///< translation error per second
  double completeness = 0;                  ///< tracked / offered
  double in_any_map = 0;                    ///< share of the offered frames with a pose in any map
};

template <MaybeConst<TrajectoryScore> S, class Visit>
void fields(S& score, Visit& v) {
  using enum Better;
  auto& [offered, tracked, scored, ate_rmse_m, ate_median_m, ate_rmse_deg, ate_first_pose_m,
         rpe_frame_rmse_m, rpe_second_rmse_m, completeness, in_any_map] = score;
  v(Metric{.name = "offered"}, offered);
  v(Metric{.name = "tracked"}, tracked);
  v(Metric{.name = "scored"}, scored);
  v(Metric{"ate_rmse_m", "ATE m", "m", 4, kLess, "", true}, ate_rmse_m);
  v(Metric{"ate_median_m", "ATE median", "m", 4, kLess}, ate_median_m);
  v(Metric{"ate_rmse_deg", "ATE deg", "deg", 3, kLess}, ate_rmse_deg);
  v(Metric{"ate_first_pose_m", "first pose m", "m", 4, kLess}, ate_first_pose_m);
  v(Metric{"rpe_frame_rmse_m", "RPE m/fr", "m", 5, kLess, "", true}, rpe_frame_rmse_m);
  v(Metric{"rpe_second_rmse_m", "RPE m/s", "m", 5, kLess}, rpe_second_rmse_m);
  v(Metric{"completeness", "complete", "%", 2, kMore, "offered", true}, completeness);
  v(Metric{"in_any_map", "", "%", 2, kMore, "offered"}, in_any_map);
}

/// Computes ATE, RPE and completeness of an estimate, as evaluate() defines them.
/// @param truth    true poses of the frames of the sequence
/// @param offered  frames that the system was supposed to map
TrajectoryScore score_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                 std::size_t offered);

/// Where an estimate's world is in the true one.
struct EstimateAlignment {
  /// By least squares over all positions. A path that determines no alignment because it is too
  /// short or straight is aligned by its first pose.
  SE3 truth_from_estimate;
  /// Aligns only the first tracked pose with the truth, since a robot knows where its dock is. The
  /// occupancy map and images use this frame.
  SE3 dock_from_estimate;
};
EstimateAlignment align_estimate(const Trajectory& estimate, const Trajectory& truth);

}  // namespace mh
