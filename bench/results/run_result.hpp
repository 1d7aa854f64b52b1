// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/metrics/query_summary.hpp"
#include "bench/metrics/trajectory_score.hpp"
#include "bench/plan/runs.hpp"
#include "bench/protocol/mapping.hpp"
#include "bench/protocol/score.hpp"
#include "bench/provenance/place_facts.hpp"
#include "bench/results/call_times.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/occupancy/occupancy.hpp"

namespace mh {

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
  EstimateFrames frames;
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

/// A run that came to nothing.
struct FailedRun {
  RunSpec spec;
  std::string error;
};

inline const std::vector<QueryScore>& queries(const PointResult& point, QuerySet set) {
  return set == QuerySet::kHeldOut ? point.held_out : point.second_tour;
}

/// Calls visit(query) for every query of a run: by point, then set, then as they were put.
template <class Visit>
void for_each_query(const RunResult& run, Visit visit) {
  for (const PointResult& point : run.points)
    for (const QuerySet set : kQuerySets)
      for (const QueryScore& query : queries(point, set)) visit(query);
}

}  // namespace mh
