// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/plan/runs.hpp"
#include "bench/protocol/mapping.hpp"
#include "bench/protocol/score.hpp"
#include "bench/provenance/place_facts.hpp"
#include "bench/results/call_times.hpp"
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

/// The answers under one of the run's parameter points.
struct PointResult {
  std::vector<QueryScore> held_out;
  std::vector<QueryScore> second_tour;  ///< never pooled with held_out
};

/// When and where a run's times were measured: those of different sittings do not compare.
struct Circumstances {
  std::string host;
  std::string sitting;  ///< when the command began that made the run, UTC; empty: unknown
  int jobs = 0;         ///< runs that it had at work side by side
  double load = 0;      ///< of the last minute, processes at work per processor
};

/// All that one run gave.
struct RunResult {
  RunSpec spec;
  PlaceFacts place;
  Trajectory truth;  ///< of every frame of the mapping tour
  MappingOutcome mapping;
  Trajectory estimate;
  TrajectoryScore trajectory;
  std::vector<PointResult> points;                ///< as spec.points
  std::shared_ptr<const OccupancyMapper> volume;  ///< keyframe depth at its final poses, dock frame
  OccupancyGrid grid;                             ///< what of it stands in a robot's way
  std::uint64_t map_digest = 0;                   ///< of trajectory and grid
  CallTimes times;                                ///< not deterministic: never part of results.json
  // Likewise not deterministic. Processor time of making the frames, and of what is neither SLAM
  // nor scored: octree, grid, pictures.
  double frames_s = 0, products_s = 0;
  double wall_s = 0;
  Circumstances circumstances;
};

/// Whether a system reported how far its relocalization came: a program need not.
inline bool reports_stage(const SystemSpec& system, RelocalizationStage stage) {
  return system.takes_settings() || stage != RelocalizationStage::kNone;
}

/// A run that came to nothing.
struct FailedRun {
  RunSpec spec;
  std::string error;
};

/// Which test frames: never pooled with one another.
enum class QuerySet { kHeldOut, kSecondTour };
std::string_view name(QuerySet set);
inline constexpr QuerySet kQuerySets[] = {QuerySet::kHeldOut, QuerySet::kSecondTour};

inline const std::vector<QueryScore>& queries(const PointResult& point, QuerySet set) {
  return set == QuerySet::kHeldOut ? point.held_out : point.second_tour;
}

}  // namespace mh
