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

/// The scenes of one category combined, in the form of the paper's Table 1: each figure is the mean
/// over scenes of the scene's median over trials (a Row).
struct CategoryRow {
  std::string category;
  std::size_t level = 0, system = 0, parameters = 0;
  Labels labels;
  std::size_t scenes =
      0;  ///< number of scenes with a result, over which all figures are computed; may be 0
  std::size_t of = 0;                          ///< number of scenes of the category in the suite
  std::size_t failed = 0;                      ///< failed runs in all of these scenes
  TrajectoryScore trajectory;                  ///< each figure is over the scenes that have it
  QuerySummary held_out, second_tour, graded;  ///< over the scenes with such queries
};
inline const QuerySummary& summary(const CategoryRow& row, QuerySet set) {
  return of_query_set(row, set);
}

/// Returns rows ordered by level, labels, parameters, category (by the category's first
/// environment, with "all" last) and system.
std::vector<CategoryRow> make_category_rows(const Suite& suite, std::span<const Row> rows);

/// Differences (first minus second) over scenes of each pair of systems that the suite compares.
/// Holm's correction covers one family per pair, level and parameter point: the share that the
/// suite's `measure` names (correct or success), the distance over the queries that both answered,
/// and the ATE over the frames that both tracked. Outside the family are the other share, false
/// positives, and both shares over the pooled queries of all scenes, with scenes as clusters.
struct SceneFamily {
  std::size_t level = 0, parameters = 0;
  SystemPair systems;
  std::vector<Comparison> comparisons;
};
std::vector<SceneFamily> compare_over_scenes(const Suite& suite, std::span<const Row> rows);

/// Whether there are enough pairs to detect a loss as large as the margin. By the rule of three,
/// fewer than 3 / margin pairs may show no loss just by chance.
bool enough_for(const Comparison& share, double margin);

/// Whether the first system is not inferior by more than the margin: the interval of a share's
/// difference lies above -margin, and there are enough pairs.
bool not_inferior(const Comparison& share, double margin);

}  // namespace mh
