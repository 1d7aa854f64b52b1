// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/results/scenes.hpp"

namespace mh {

/// What one system answered over the points of a sweep, at one level with one kind of labels, all
/// environments together.
struct SweepResult {
  std::size_t level = 0, system = 0;
  LabelMode labels = LabelMode::kNone;
  std::vector<SharedSlamConfig> points;  ///< as the suite states them
  std::vector<CategoryRow> answers;      ///< as points
};

/// One per level, labels and system that sees more than one point of the sweep; in this order.
std::vector<SweepResult> sweep_results(const Suite& suite, std::span<const Row> rows);

/// The point with the largest share of correct answers, beside the point of the suite's own
/// settings (the first one, where the sweep does not come by them). Of equals the suite's own is
/// best, then the first. Chosen among many by the same queries, it flatters; the interval does not
/// correct for that, so a point is taken over from tuning scenes alone.
struct BestPoint {
  std::size_t point = 0, reference = 0;
  std::size_t equals = 1;  ///< points with as many correct answers, itself among them
  /// Of one environment by blocks of queries, of more by scenes.
  Comparison to_reference;
};

/// nullopt where these queries were not put.
std::optional<BestPoint> best_point(const Suite& suite, std::span<const Row> rows,
                                    const SweepResult& result, QuerySet set);

}  // namespace mh
