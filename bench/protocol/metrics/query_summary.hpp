// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/protocol/metrics/metric.hpp"

namespace mh {

/// The sets of queries; they are never pooled.
enum class QuerySet {
  kHeldOut,     ///< test frames of the mapping tour
  kSecondTour,  ///< test frames of another tour
  kGraded,      ///< drawn for given distances and angles from the nearest mapped view
};
inline constexpr QuerySet kQuerySets[] = {QuerySet::kHeldOut, QuerySet::kSecondTour,
                                          QuerySet::kGraded};
inline std::string_view name(QuerySet set) {
  return set == QuerySet::kHeldOut      ? "held_out"
         : set == QuerySet::kSecondTour ? "second_tour"
                                        : "graded";
}

/// Returns the member for one set from a record that has a member for each set.
template <class Sets>
auto& of_query_set(Sets& sets, QuerySet set) {
  return set == QuerySet::kHeldOut      ? sets.held_out
         : set == QuerySet::kSecondTour ? sets.second_tour
                                        : sets.graded;
}

/// Summary of one run's answers to one set of queries, or of many such summaries.
struct QuerySummary {
  double queries = 0;
  double success = 0;  ///< share of all queries
  /// Shares of all queries; absent if none can be judged because the truth is unknown.
  std::optional<double> correct, false_positive;
  std::optional<double> in_map;          ///< share of queries whose place is in the map
  std::optional<double> success_in_map;  ///< share of those queries that were answered: mapping and
                                         ///< relocalization told apart
  /// Distance to the local truth, over the answered queries; absent if none was answered.
  std::optional<double> distance_mean_m, distance_median_m;
  std::optional<double> aligned_distance_mean_m;  ///< the same, in the globally aligned frame
  double attempts = 0;                            ///< mean number per query
  /// Keyframes in the map and candidates left after equations 3, 4, 5 and 6: mean counts over the
  /// queries for which the system reports them; absent if it reports none.
  std::optional<double> keyframes, c1, c2, c3, final;
  std::optional<double> single_candidate;  ///< share of queries with exactly one candidate left
  std::optional<double> label_mass;        ///< mean share of the query vector held by labels
  std::optional<double> gamma;             ///< mean weight of a label, equation 1
  /// Means of the fields of the same names in Candidates.
  std::optional<double> unscored{}, stale{}, stale_weight{}, stale_age{};
};

template <MaybeConst<QuerySummary> S, class Visit>
void fields(S& summary, Visit& v) {
  using enum Better;
  auto& [queries, success, correct, false_positive, in_map, success_in_map, distance_mean_m,
         distance_median_m, aligned_distance_mean_m, attempts, keyframes, c1, c2, c3, final,
         single_candidate, label_mass, gamma, unscored, stale, stale_weight, stale_age] = summary;
  v(Metric{.name = "queries"}, queries);
  v(Metric{"success", "success", "%", 2, kMore, "queries", true}, success);
  v(Metric{"correct", "correct", "%", 2, kMore, "queries", true}, correct);
  v(Metric{"false_positive", "false pos.", "%", 2, kLess, "queries", true}, false_positive);
  v(Metric{.name = "in_map", .heading = "in map", .unit = "%", .decimals = 2}, in_map);
  v(Metric{.name = "success_in_map",
           .heading = "where mapped",
           .unit = "%",
           .decimals = 2,
           .in_overview = true},
    success_in_map);
  v(Metric{"distance_mean_m", "mean m", "m", 4, kLess, "", true}, distance_mean_m);
  v(Metric{"distance_median_m", "median m", "m", 4, kLess}, distance_median_m);
  v(Metric{"aligned_distance_mean_m", "aligned m", "m", 4, kLess}, aligned_distance_mean_m);
  v(Metric{"attempts", "attempts", "", 2, kLess}, attempts);
  v(Metric{.name = "candidates.keyframes"}, keyframes);
  v(Metric{.name = "candidates.c1"}, c1);
  v(Metric{.name = "candidates.c2"}, c2);
  v(Metric{.name = "candidates.c3"}, c3);
  v(Metric{.name = "candidates.final"}, final);
  v(Metric{.name = "candidates.single", .unit = "%"}, single_candidate);
  v(Metric{.name = "candidates.label_mass", .unit = "%"}, label_mass);
  v(Metric{.name = "candidates.gamma"}, gamma);
  v(Metric{.name = "candidates.unscored", .unit = "%"}, unscored);
  v(Metric{.name = "candidates.stale", .unit = "%"}, stale);
  v(Metric{.name = "candidates.stale_weight", .unit = "%"}, stale_weight);
  v(Metric{.name = "candidates.stale_age"}, stale_age);
}

}  // namespace mh
