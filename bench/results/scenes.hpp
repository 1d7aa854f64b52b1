// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/results/rows.hpp"

namespace mh {

/// Name of the category that contains all scenes.
inline constexpr std::string_view kAllCategories = "all";

/// The scenes of one category combined, in the form of the paper's Table 1: the mean over scenes of
/// each scene's median over trials (a Row).
struct CategoryRow {
  std::string category;
  std::size_t level = 0, system = 0, parameters = 0;
  Labels labels;
  std::size_t scenes = 0;  ///< where the system has a result; all figures are over these; may be 0
  std::size_t of = 0;      ///< scenes of the category in the suite
  std::size_t failed = 0;  ///< failed runs in all of these scenes
  TrajectoryScore trajectory;                  ///< each figure over the scenes that have it
  QuerySummary held_out, second_tour, graded;  ///< over the scenes with such queries
};
inline const QuerySummary& summary(const CategoryRow& row, QuerySet set) {
  return of_query_set(row, set);
}

/// By level, labels, parameters and category (in the order of their first environments, "all"
/// last), then system.
std::vector<CategoryRow> make_category_rows(const Suite& suite, std::span<const Row> rows);

/// First minus second for each pair that the suite compares, over scenes: one family per pair,
/// level and parameter point, with Holm's correction. It contains the share that the suite's
/// `measure` names (correct or success), the distance over the queries that both answered, and the
/// ATE over the frames that both tracked. Outside the family are the other share, false positives,
/// and both shares over all queries pooled, with scenes as clusters.
struct SceneFamily {
  std::size_t level = 0, parameters = 0;
  SystemPair systems;
  std::vector<Comparison> comparisons;
};
std::vector<SceneFamily> compare_over_scenes(const Suite& suite, std::span<const Row> rows);

/// Whether there are enough pairs to detect a loss as large as the margin: by the rule of three,
/// fewer than 3 / margin may show no loss by chance.
bool enough_for(const Comparison& share, double margin);

/// Whether the interval of a share stays above -margin, over enough pairs: not inferior by more
/// than the margin.
bool not_inferior(const Comparison& share, double margin);

}  // namespace mh
