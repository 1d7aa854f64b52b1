// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "bench/protocol/query_means.hpp"
#include "bench/protocol/run_result.hpp"
#include "bench/results/statistics.hpp"

namespace mh {

/// A run and one of its parameter points.
struct Trial {
  const RunResult* run = nullptr;
  const PointResult* point = nullptr;
};

/// One row of the results: one system in one environment under one kind of labels at one level and
/// one parameter point, over all trials.
struct Row {
  std::size_t environment = 0, level = 0, system = 0;  ///< indices into the suite's lists
  Labels labels;
  std::size_t parameters = 0;  ///< index into parameter_points(suite)
  std::vector<Trial> trials;   ///< the finished trials
  std::size_t failed = 0;      ///< number of failed runs
  TrajectoryScore trajectory;  ///< medians over the trials that have the score
  MappingCounts mapping;       ///< medians over the trials
  QuerySummary held_out, second_tour, graded;
  std::optional<MatchCounts>
      matches;  ///< summed over trials, mapping and queries, as far as matches were reported
  TimeSummary track, relocalize;
};
inline const QuerySummary& summary(const Row& row, QuerySet set) {
  return of_query_set(row, set);
}

/// Returns one row per environment, level, labels, parameter point and system that has a run, in
/// this order. The plain system, run once without labels, appears with each kind of labels.
/// @param failed  runs that count as failures in their rows; a row with only failed runs has no
/// trials
std::vector<Row> make_rows(const Suite& suite, std::span<const RunResult> runs,
                           std::span<const FailedRun> failed = {});

/// Rows that differ only in the system, and their comparisons.
struct Family {
  std::size_t environment = 0, level = 0;
  SystemPair systems;
  std::vector<Comparison> comparisons;
};

/// Differences (first minus second) of each pair of systems that the suite compares, at the first
/// parameter point, for each environment, level, kind of labels, query set and measure. A family
/// for Holm's correction consists of one pair's comparisons in one environment at one level: for
/// each kind of labels and query set, the share that the suite's `measure` names (correct or
/// success) and the distance where both answer. The other share is shown alongside.
std::vector<Family> compare_systems(const Suite& suite, std::span<const Row> rows);

/// For each query made to both systems, in order: first minus second, where each value is the
/// median over trials.
std::vector<PairedDifference> paired_success(const Row& first, const Row& second, QuerySet set);
/// The same for correct answers; absent for a query whose answers cannot be judged.
std::vector<PairedDifference> paired_correct(const Row& first, const Row& second, QuerySet set);

/// The number of queries of a set that two rows share, which is the number of yes-or-no answers
/// behind a difference of shares.
std::size_t shared_queries(const Row& first, const Row& second, QuerySet set);

/// Compares distances (first minus second) over the queries that both systems answered. Queries are
/// resampled in blocks.
Comparison compare_distances(const Row& first, const Row& second, QuerySet set,
                             std::uint64_t seed = 0);

/// Compares shares of correct answers in the same way.
Comparison compare_correct(const Row& first, const Row& second, QuerySet set, std::uint64_t seed);

/// ATE of the first and of the second system over the frames that both tracked, as medians over the
/// trials that both have.
std::array<std::optional<double>, 2> ate_over_common_frames(const Row& first, const Row& second);

}  // namespace mh
