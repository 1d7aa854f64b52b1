// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "bench/results/run_result.hpp"
#include "bench/results/statistics.hpp"

namespace mh {

/// The answers of one run to one set of queries, or the median of that over trials.
struct QuerySummary {
  double queries = 0;
  double success = 0;  ///< share of all queries
  /// Likewise; absent where none can be judged, since nobody knows the truth.
  std::optional<double> correct, wrong;
  /// Over the queries that were answered, local truth; absent where none was.
  std::optional<double> distance_mean_m, distance_median_m;
  std::optional<double> aligned_distance_mean_m;  ///< the same, in the globally aligned frame
  double attempts = 0;                            ///< mean
  /// Candidate keyframes left after equations 3, 4, 5 and 6: mean counts over the queries where the
  /// system tells them; absent where it tells none.
  std::optional<double> keyframes, c1, c2, c3, final;
  std::optional<double> single_candidate;  ///< share of queries with exactly one left
  std::optional<double> label_mass;        ///< mean share of the query vector held by labels
};
QuerySummary summarize(std::span<const QueryScore> queries);

/// Field by field, one summary of many: `of` over the values, `of_known` where some may be absent.
QuerySummary reduce(
    std::span<const QuerySummary> summaries,
    const std::function<double(const std::vector<double>&)>& of,
    const std::function<std::optional<double>(const std::vector<std::optional<double>>&)>&
        of_known);

/// A run and one of its parameter points.
struct Trial {
  const RunResult* run = nullptr;
  const PointResult* point = nullptr;
};

/// One row of the results: one system in one environment under one kind of labels at one level and
/// one parameter point, over all trials.
struct Row {
  std::size_t environment = 0, level = 0, system = 0;  ///< indices into the suite's lists
  LabelMode labels = LabelMode::kNone;
  std::size_t parameters = 0;  ///< index into parameter_points(suite)
  std::vector<Trial> trials;   ///< those that are done
  std::size_t failed = 0;      ///< runs of it that failed
  TrajectoryScore trajectory;  ///< medians over the trials that have the score
  double restarts = 0, dropped = 0;
  QuerySummary held_out, second_tour;
  MatchCounts matches{};  ///< summed over trials, mapping and queries
  TimeSummary track, relocalize;
};
inline const QuerySummary& summary(const Row& row, QuerySet set) {
  return set == QuerySet::kHeldOut ? row.held_out : row.second_tour;
}

/// One row per environment, level, labels, parameter point and system, in this order, where there
/// is a run of it. The plain system, run once without labels, stands beside each kind of label.
/// @param failed  counted in their rows; a row of which nothing else is left has no trials
std::vector<Row> make_rows(const Suite& suite, std::span<const RunResult> runs,
                           std::span<const FailedRun> failed = {});

/// What is compared: rows that differ in nothing but the system.
struct Family {
  std::size_t environment = 0, level = 0;
  SystemPair systems;
  std::vector<Comparison> comparisons;
};

/// First minus second of each pair that the suite compares, at its first parameter point, for each
/// environment, level, label kind, query set and measure. The family of one pair, environment and
/// level, over which Holm corrects, are the two figures of the paper's Table 2 for each label kind
/// and query set: success, and the distance where both answer. *Correct* stands beside it: where
/// nothing is false it is success.
std::vector<Family> compare_systems(const Suite& suite, std::span<const Row> rows);

/// Distances over the queries that both answered, first minus second, by blocks of queries.
Comparison compare_distances(const Row& first, const Row& second, QuerySet set,
                             std::string what = "", std::uint64_t seed = 0);

/// Shares of correct answers likewise.
Comparison compare_correct(const Row& first, const Row& second, QuerySet set, std::uint64_t seed);

/// ATE over the frames that both tracked, median over the trials that both have: first, second.
std::array<std::optional<double>, 2> ate_over_common_frames(const Row& first, const Row& second);

}  // namespace mh
