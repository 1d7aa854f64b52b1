// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bench/plan/runs.hpp"
#include "bench/protocol/mapping.hpp"
#include "bench/protocol/score.hpp"
#include "bench/systems/timed.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/occupancy/occupancy.hpp"

namespace mh {

/// How good the mapping tour's trajectory is.
struct TrajectoryScore {
  std::size_t offered = 0;
  std::size_t tracked = 0;  ///< frames with a pose in the end
  double completeness = 0;  ///< tracked / offered
  // Absent where the path does not determine them: too short, or on a line.
  std::optional<double> ate_rmse_m;         ///< after SE(3) alignment without scale
  std::optional<double> ate_first_pose_m;   ///< in the frame of dock_from_estimate
  std::optional<double> rpe_frame_rmse_m;   ///< translation error per frame step
  std::optional<double> rpe_second_rmse_m;  ///< translation error per second
  SE3 truth_from_estimate;                  ///< the alignment
  /// The first tracked pose put onto the truth, nothing else: a robot knows where its dock stands.
  /// The frame of the occupancy map and of the pictures.
  SE3 dock_from_estimate;
};

/// All that one run gave.
struct RunResult {
  RunSpec spec;
  MappingOutcome mapping;
  Trajectory estimate;
  TrajectoryScore trajectory;
  std::vector<QueryScore> held_out;
  std::vector<QueryScore> second_tour;            ///< never pooled with held_out
  std::shared_ptr<const OccupancyMapper> volume;  ///< keyframe depth at its final poses, dock frame
  OccupancyGrid grid;                             ///< what of it stands in a robot's way
  CallTimes times;                                ///< not deterministic: never part of results.json
  double wall_s = 0;                              ///< likewise
};

}  // namespace mh
