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

namespace mh {

/// How good the mapping tour's trajectory is.
struct TrajectoryScore {
  std::size_t offered = 0;
  std::size_t tracked = 0;       ///< frames with a pose in the end
  double completeness = 0;       ///< tracked / offered
  double ate_rmse_m = 0;         ///< after SE(3) alignment without scale
  double ate_unaligned_m = 0;    ///< first poses put together, nothing else
  double rpe_frame_rmse_m = 0;   ///< translation error per frame step
  double rpe_second_rmse_m = 0;  ///< translation error per second
  SE3 truth_from_estimate;       ///< the alignment
};

/// Depth of a keyframe, kept for the occupancy map: every second pixel of every second row.
struct KeyframeDepth {
  Stamp stamp_ns = 0;
  Grid2d<float> depth_m;
};

/// All that one run gave.
struct RunResult {
  RunSpec spec;
  MappingOutcome mapping;
  Trajectory estimate;
  TrajectoryScore trajectory;
  std::vector<QueryScore> held_out;
  std::vector<QueryScore> second_tour;  ///< never pooled with held_out
  std::uint64_t map_digest = 0;         ///< of the final trajectory and the occupancy map
  CallTimes times;                      ///< not deterministic: never part of results.json
  double wall_s = 0;                    ///< likewise
};

}  // namespace mh
