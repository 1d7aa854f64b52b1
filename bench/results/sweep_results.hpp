// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/results/scenes.hpp"

namespace mh {

/// One system's answers over the points of a sweep, at one level with one kind of labels, all
/// environments combined.
struct SweepResult {
  std::size_t level = 0, system = 0;
  Labels labels;
  std::vector<SharedSlamConfig> points;  ///< in the form in which the suite states them
  std::vector<CategoryRow> answers;      ///< in the order of `points`
};

/// Returns one result per level, labels and system that uses more than one point of the sweep, in
/// this order.
std::vector<SweepResult> sweep_results(const Suite& suite, std::span<const Row> rows);

/// The point with the largest share of correct answers, compared with the point of the suite's own
/// settings (or the first point, if the sweep does not include them). Ties go to the suite's own
/// settings, then to the earliest point. The best point is selected and scored on the same queries,
/// so its result is optimistic, and the interval does not correct for that: adopt a point only from
/// a sweep over tuning scenes.
struct BestPoint {
  std::size_t point = 0, reference = 0;
  std::size_t equals =
      1;  ///< number of points that tie for the most correct answers, including this one
  /// The best point minus the reference: over blocks of queries for one environment, over scenes
  /// for several.
  Comparison to_reference;
};

/// nullopt if no queries of the set were made, or their answers cannot be judged.
std::optional<BestPoint> best_point(const Suite& suite, std::span<const Row> rows,
                                    const SweepResult& result, QuerySet set);

}  // namespace mh
