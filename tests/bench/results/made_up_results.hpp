// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "bench/protocol/run_result.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/io/files.hpp"

namespace mh {

/// Answers to one set of queries: the first ones are correct, the next ones false, the rest
/// unanswered. The first query's place is in no map.
struct MadeUpAnswers {
  int correct = 0;
  std::vector<double> distances_m;   ///< of the answered queries
  double aligned_more_m = 0;         ///< how much larger the distances are after alignment
  std::vector<int> attempts, final;  ///< of all queries
  int keyframes = 0, c1 = 0, c2 = 0, c3 = 0;
  double label_mass = 0, gamma = 0;
  std::optional<double> unscored{}, stale{}, stale_weight{}, stale_age{};
  RelocalizationStage unanswered = RelocalizationStage::kNone;
};

/// All figures of a run; no two of the numbers are equal.
struct MadeUpFigures {
  double completeness = 0, ate_m = 0, ate_deg = 0, first_pose_m = 0, rpe_frame_m = 0,
         rpe_second_m = 0;
  int restarts = 0;
  std::size_t dropped = 0;
  MadeUpAnswers held_out, second_tour;
  MatcherCounts pairs;  ///< pairs matched with the motion model while mapping
  std::vector<double> track_ms, relocalize_ms;
};

inline std::vector<QueryScore> made_up_queries(const MadeUpAnswers& a) {
  std::vector<QueryScore> queries;
  for (std::size_t i = 0; i < a.attempts.size(); ++i) {
    QueryScore q;
    q.answer.index = 29 + 30 * i;
    q.stamp_ns = static_cast<Stamp>(q.answer.index);
    q.true_world_from_camera = SE3();
    q.answer.attempts = a.attempts[i];
    q.answer.candidates = {.keyframes = a.keyframes,
                           .c1 = a.c1,
                           .c2 = a.c2,
                           .c3 = a.c3,
                           .final = a.final[i],
                           .label_mass = a.label_mass,
                           .gamma = a.gamma,
                           .unscored = a.unscored,
                           .stale = a.stale,
                           .stale_weight = a.stale_weight,
                           .stale_age = a.stale_age};
    q.answer.stage = a.unanswered;
    q.in_map = i > 0;
    if (i < a.distances_m.size()) {
      q.success = true;
      q.correct = i < static_cast<std::size_t>(a.correct);
      q.false_positive = !q.correct;
      q.answer.stage = RelocalizationStage::kVerified;
      q.answer.world_from_camera = SE3();
      q.distance_m = a.distances_m[i];
      q.angle_deg = 10 * a.distances_m[i];
      q.aligned_distance_m = a.distances_m[i] + a.aligned_more_m;
    }
    queries.push_back(q);
  }
  return queries;
}

inline RunResult made_up_run(const RunSpec& spec, const MadeUpFigures& figures) {
  RunResult run;
  run.spec = spec;
  run.place.scene = "room";
  run.trajectory = {.offered = 1000,
                    .tracked = 1000 * figures.completeness,
                    .scored = 999 * figures.completeness,
                    .ate_rmse_m = figures.ate_m,
                    .ate_median_m = 0.6 * figures.ate_m,
                    .ate_rmse_deg = figures.ate_deg,
                    .ate_first_pose_m = figures.first_pose_m,
                    .rpe_frame_rmse_m = figures.rpe_frame_m,
                    .rpe_second_rmse_m = figures.rpe_second_m,
                    .completeness = figures.completeness,
                    .in_any_map = 0.5 * (1 + figures.completeness)};
  run.mapping.restarts = figures.restarts;
  for (std::size_t i = 0; i < figures.dropped; ++i) run.mapping.dropped.push_back(i);
  run.mapping.matches.emplace()[0] = figures.pairs;
  run.points = {{.held_out = made_up_queries(figures.held_out),
                 .second_tour = made_up_queries(figures.second_tour)}};
  run.times.track_ms = figures.track_ms;
  run.times.relocalize_ms = figures.relocalize_ms;
  return run;
}

/// A suite of these environments that needs no files except its own.
inline Suite made_up_suite(const std::filesystem::path& folder,
                           const std::vector<std::string>& environments) {
  const std::filesystem::path file = folder / "made_up.yaml";
  {
    std::ofstream text(file);
    text << "environments:\n";
    for (const std::string& name : environments)
      text << "- {name: " << name << ", category: rooms, scene: " << name
           << ".yaml, mapping_tour: t.yaml, query_tour: q.yaml}\n";
    text << "robot: robot.yaml\nvocabulary: v.mhvoc\nlevels: [pepper.yaml]\n"
            "systems: [semantic, plain]\nlabels: [exact]\n";
  }
  return parse_suite(read_file(file), file, {}, false);
}

}  // namespace mh
