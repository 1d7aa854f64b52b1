// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bench/audit/matches.hpp"
#include "bench/protocol/metrics/query_summary.hpp"
#include "slam/core/relocalization_stage.hpp"
#include "slam/io/fields.hpp"
#include "slam/io/words.hpp"

namespace mh {

/// A keyframe that shows less than this share of what a query sees counts as showing nothing of it.
inline constexpr double kInSight = 0.1;
/// A keyframe is relevant to a query if it shows at least this share of what the query sees.
inline constexpr double kRelevant = 0.25;
/// How many keyframes count as "the nearest", by true distance, where 1 rad counts as 1 m.
inline constexpr std::size_t kNearest = 5;

/// Why the first attempt at a query gave no correct answer: the first of these that applies.
enum class FirstCause {
  kNone,             ///< it was correct
  kWrongCandidates,  ///< some keyframe alone would have given a correct answer
  kNothingInSight,   ///< no keyframe shows at least kInSight of what the query sees
  kFewMatches,       ///< no keyframe has enough word matches to try a pose
  kFalseAnswer,      ///< a pose was returned
  kFewInliers        ///< no pose had enough inliers
};

constexpr Names<FirstCause, 6> words(FirstCause) {
  return {{{"none", FirstCause::kNone},
           {"wrong_candidates", FirstCause::kWrongCandidates},
           {"nothing_in_sight", FirstCause::kNothingInSight},
           {"few_matches", FirstCause::kFewMatches},
           {"false_answer", FirstCause::kFalseAnswer},
           {"few_inliers", FirstCause::kFewInliers}}};
}

/// The audit of one query under one parameter point. Everything but `correct` and `attempts` refers
/// to the first attempt.
struct QueryAudit {
  std::size_t frame = 0;  ///< index in its sequence
  bool correct = false;   ///< in the run, after all its attempts
  int attempts = 0;
  bool first_answered = false, first_correct = false;
  RelocalizationStage stage = RelocalizationStage::kNone;
  FirstCause cause = FirstCause::kNone;

  // Where the query is. Co-visibility is the share of the surface seen by the query that a keyframe
  // also shows.
  double best_co_visible = 0;
  std::optional<double> nearest_m = {},
                        nearest_deg = {};  ///< to the nearest keyframe by true pose, if any
  int keyframes = 0, relevant = 0;

  // Retrieval: what Algorithm 1 chose, and how all keyframes rank by similarity (equation 5).
  int candidates = 0, relevant_candidates = 0;
  std::optional<int> solving_candidate = {};  ///< rank, from 1, of the first that solves the query
  std::optional<double> average_precision = {};
  std::optional<double> precision_1 = {}, precision_5 = {}, precision_10 = {};
  std::optional<double> recall_1 = {}, recall_5 = {}, recall_10 = {};
  std::optional<int> solving_rank = {};  ///< likewise, among all keyframes by similarity
  std::optional<double> solving_m = {}, solving_deg = {},
                        solving_co_visible = {};  ///< of that keyframe
  double label_mass = 0;

  // Ceilings: what would solve the query. The last two are true whenever by_any is.
  bool by_any = false;          ///< some keyframe as the only candidate
  bool by_nearest = false;      ///< one of the kNearest keyframes
  bool without_false = false;   ///< some keyframe, with all false matches removed
  bool with_true_pose = false;  ///< some keyframe, if guided searches start from the true pose
  MatchAudit matches{};
};

template <MaybeConst<QueryAudit> A, class Visit>
void fields(A& audit, Visit& v) {
  auto& [frame, correct, attempts, first_answered, first_correct, stage, cause, best_co_visible,
         nearest_m, nearest_deg, keyframes, relevant, candidates, relevant_candidates,
         solving_candidate, average_precision, precision_1, precision_5, precision_10, recall_1,
         recall_5, recall_10, solving_rank, solving_m, solving_deg, solving_co_visible, label_mass,
         by_any, by_nearest, without_false, with_true_pose, matches] = audit;
  v("frame", frame);
  v("correct", correct);
  v("attempts", attempts);
  v("first_answered", first_answered);
  v("first_correct", first_correct);
  v("stage", stage);
  v("cause", cause);
  v("best_co_visible", best_co_visible);
  v("nearest_m", nearest_m);
  v("nearest_deg", nearest_deg);
  v("keyframes", keyframes);
  v("relevant", relevant);
  v("candidates", candidates);
  v("relevant_candidates", relevant_candidates);
  v("solving_candidate", solving_candidate);
  v("average_precision", average_precision);
  v("precision_1", precision_1);
  v("precision_5", precision_5);
  v("precision_10", precision_10);
  v("recall_1", recall_1);
  v("recall_5", recall_5);
  v("recall_10", recall_10);
  v("solving_rank", solving_rank);
  v("solving_m", solving_m);
  v("solving_deg", solving_deg);
  v("solving_co_visible", solving_co_visible);
  v("label_mass", label_mass);
  v("by_any", by_any);
  v("by_nearest", by_nearest);
  v("without_false", without_false);
  v("with_true_pose", with_true_pose);
  v("matches", matches);
}

/// The queries of one parameter point.
struct PointAudit {
  std::vector<QueryAudit> held_out = {}, second_tour = {}, graded = {};
};
inline const std::vector<QueryAudit>& queries(const PointAudit& point, QuerySet set) {
  return of_query_set(point, set);
}
inline std::vector<QueryAudit>& queries(PointAudit& point, QuerySet set) {
  return of_query_set(point, set);
}

template <MaybeConst<PointAudit> A, class Visit>
void fields(A& point, Visit& v) {
  auto& [held_out, second_tour, graded] = point;
  v("held_out", held_out);
  v("second_tour", second_tour);
  v("graded", graded);
}

/// The audit of one run.
struct RunAudit {
  std::vector<PointAudit> points;  ///< in the order of RunSpec::points
  // CPU time, s: not deterministic.
  double audit_s = 0, run_s = 0;
  bool map_from_cache = false;  ///< run_s then excludes the mapping
};

template <MaybeConst<RunAudit> A, class Visit>
void fields(A& audit, Visit& v) {
  auto& [points, audit_s, run_s, map_from_cache] = audit;
  v("points", points);
  v("audit_s", audit_s);
  v("run_s", run_s);
  v("map_from_cache", map_from_cache);
}

}  // namespace mh
