// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/audit/query_audit.hpp"
#include "bench/suite/run_spec.hpp"
#include "bench/suite/suite.hpp"

namespace mh {

/// A run with its audit.
struct AuditedRun {
  RunSpec spec;
  std::string key;  ///< of the run's result (bench/suite/run_key.hpp)
  RunAudit audit;
};

/// Summary of the queries of one set. Shares refer to all queries unless stated otherwise; a mean
/// is taken over the queries that have the value, and absent if no query has it. A query is
/// solvable if QueryAudit::by_any is true.
struct AuditSummary {
  std::size_t queries = 0;
  double correct = 0;        ///< in the run, after all attempts
  double first_correct = 0;  ///< at the first attempt, as are all fields below
  std::optional<double> first_correct_of_solvable;
  // Failed first attempts, by first cause.
  double wrong_candidates = 0, nothing_in_sight = 0, few_matches = 0, false_answer = 0,
         few_inliers = 0;
  // Ceilings.
  double by_any = 0, by_nearest = 0, without_false = 0, with_true_pose = 0;
  // Retrieval.
  double candidates = 0;                      ///< mean
  std::optional<double> relevant_candidates;  ///< share of all candidates
  std::optional<double> candidate_solves;  ///< of solvable queries, those that a candidate solves
  std::optional<double> first_candidate_solves, most_similar_solves;  ///< of solvable queries
  std::optional<double> average_precision, precision_1, precision_5, precision_10, recall_1,
      recall_5, recall_10;
  std::optional<double> solving_rank, solving_m, solving_deg;  ///< medians
  double best_co_visible = 0, label_mass = 0;                  ///< means
  MatchAudit matches{};                                        ///< sums
};

template <MaybeConst<AuditSummary> S, class Visit>
void fields(S& summary, Visit& v) {
  auto& [queries, correct, first_correct, first_correct_of_solvable, wrong_candidates,
         nothing_in_sight, few_matches, false_answer, few_inliers, by_any, by_nearest,
         without_false, with_true_pose, candidates, relevant_candidates, candidate_solves,
         first_candidate_solves, most_similar_solves, average_precision, precision_1, precision_5,
         precision_10, recall_1, recall_5, recall_10, solving_rank, solving_m, solving_deg,
         best_co_visible, label_mass, matches] = summary;
  v("queries", queries);
  v("correct", correct);
  v("first_correct", first_correct);
  v("first_correct_of_solvable", first_correct_of_solvable);
  v("wrong_candidates", wrong_candidates);
  v("nothing_in_sight", nothing_in_sight);
  v("few_matches", few_matches);
  v("false_answer", false_answer);
  v("few_inliers", few_inliers);
  v("by_any", by_any);
  v("by_nearest", by_nearest);
  v("without_false", without_false);
  v("with_true_pose", with_true_pose);
  v("candidates", candidates);
  v("relevant_candidates", relevant_candidates);
  v("candidate_solves", candidate_solves);
  v("first_candidate_solves", first_candidate_solves);
  v("most_similar_solves", most_similar_solves);
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
  v("best_co_visible", best_co_visible);
  v("label_mass", label_mass);
  v("matches", matches);
}

AuditSummary summarize(std::span<const QueryAudit* const> queries);

/// Summaries over environments and trials: one row per level, kind of labels, system, parameter
/// point and query set that was used.
struct AuditRow {
  std::string level, system, labels;
  std::string settings;     ///< values of the varied settings; empty without a sweep
  std::string environment;  ///< empty: all of them
  QuerySet set = QuerySet::kHeldOut;
  AuditSummary summary;
};

/// @param by_environment  separate rows for each environment, instead of rows over all of them
std::vector<AuditRow> audit_rows(const Suite& suite, std::span<const AuditedRun> runs,
                                 bool by_environment = false);

}  // namespace mh
