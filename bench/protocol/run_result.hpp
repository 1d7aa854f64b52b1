// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/protocol/call_times.hpp"
#include "bench/protocol/episode_score.hpp"
#include "bench/protocol/mapping.hpp"
#include "bench/protocol/metrics/query_summary.hpp"
#include "bench/protocol/metrics/trajectory_score.hpp"
#include "bench/protocol/score.hpp"
#include "bench/suite/place_facts.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/occupancy/occupancy_grid.hpp"
#include "slam/occupancy/voxel_map.hpp"

namespace mh {

/// The answers under one of the run's parameter points.
struct PointResult {
  std::vector<QueryScore> held_out;
  std::vector<QueryScore> second_tour = {};  ///< never pooled with held_out
  std::vector<QueryScore> graded = {};       ///< never pooled with the two above
};

/// When and where a run's times were measured: times of different sessions are not comparable.
struct Circumstances {
  std::string host;
  std::string session_start;  ///< when the command that made the run started, UTC; empty: unknown
  int jobs = 0;               ///< number of runs executed in parallel
  double load = 0;            ///< load average of the last minute, per processor
};

/// Everything that one run produced.
struct RunResult {
  RunSpec spec;
  PlaceFacts place;
  Trajectory truth;  ///< of every frame of the mapping tour
  MappingOutcome mapping;
  Trajectory estimate;        ///< in the largest of the system's maps: the one that is scored
  Trajectory elsewhere = {};  ///< poses in its other maps
  TrajectoryScore trajectory;
  EstimateAlignment alignment;
  std::vector<PointResult> points;          ///< in the order of spec.points
  std::vector<EpisodeScore> episodes = {};  ///< ordered by variant as in spec.episodes, then start
  std::shared_ptr<const VoxelMap> volume;   ///< keyframe depth fused at the final poses; dock frame
  OccupancyGrid grid;                       ///< what obstructs a robot in `volume`
  std::uint64_t map_digest = 0;             ///< of trajectory and grid
  CallTimes times;                          ///< not deterministic: never part of results.json
  // Not deterministic either. CPU time spent on making the frames, and on products that are neither
  // made by SLAM nor scored: octree, grid, images.
  double frames_s = 0, products_s = 0;
  double wall_s = 0;
  Circumstances circumstances;
};

/// Splits a system's trajectory into `estimate` (the largest map) and `elsewhere`.
void set_estimate(RunResult& run, const Trajectory& all);

/// Like set_estimate(), and also scores the trajectory.
void take_trajectory(RunResult& run, const Trajectory& all);

/// The estimated poses in the map that an answer refers to.
Trajectory mapped_beside(const RunResult& run, const QueryAnswer& answer);

/// Scores an answer by the run's protocol. Only the largest map is aligned with the truth.
QueryScore score(const RunResult& run, const QueryAnswer& answer, const QueryMoment& moment,
                 const std::optional<Anchor>& anchor);

/// A run that failed.
struct FailedRun {
  RunSpec spec;
  std::string error;
};

inline const std::vector<QueryScore>& queries(const PointResult& point, QuerySet set) {
  return of_query_set(point, set);
}

/// Calls visit(query) for every query of a run: by point, then set, then query order.
template <class Visit>
void for_each_query(const RunResult& run, Visit visit) {
  for (const PointResult& point : run.points)
    for (const QuerySet set : kQuerySets)
      for (const QueryScore& query : queries(point, set)) visit(query);
}

}  // namespace mh
