// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/results/scenes.hpp"

namespace mh {

/// One system's answers to the graded queries of one bin, over all scenes and trials.
struct GradedShare {
  double success = 0, correct = 0, false_positive = 0;  ///< shares
  /// 95 % interval of the success share (Wilson, 1927), computed as if queries were independent.
  double low = 0, high = 1;
};

/// The graded queries between two edges of the quantity that they are graded by.
struct GradedBin {
  double low = 0, high = 0;
  std::size_t queries = 0;  ///< in all scenes together; each query is made in every trial
  std::vector<std::optional<GradedShare>> systems = {};  ///< by system; absent without answers
  /// Difference in success between the suite's first pair of systems (first minus second) over the
  /// same queries. With at least four scenes, the scenes are the clusters; otherwise queries are
  /// resampled in blocks.
  std::optional<Comparison> difference = {};
};

/// Success as a function of a quantity that queries are graded by.
struct GradedCurve {
  std::size_t level = 0;
  Labels labels;
  std::string category;  ///< category of the scenes, or kAllCategories
  std::string by, unit;  ///< for example "distance", "m"
  std::vector<GradedBin> bins;
};

/// Curves at the suite's first parameter point, for each level and kind of labels: success over the
/// distance and the angle to the nearest mapped view, over the share of the view that the map shows
/// and, if there are several speeds, over the speed. If the suite has several categories, success
/// over distance is also given for each category. Empty without graded queries.
std::vector<GradedCurve> graded_curves(const Suite& suite, std::span<const Row> rows);

/// How many queries were made in a suite's scenes, and how many further views were drawn but left
/// out because the mapped frames show too little of what they see.
struct GradedDraws {
  std::size_t asked = 0, hidden = 0;
  std::size_t short_cells = 0, cells = 0;  ///< bins with fewer queries than wanted; all bins
};
GradedDraws graded_draws(const Suite& suite, std::span<const Row> rows);

/// Wilson's 95 % interval of a share (Wilson, 1927).
std::pair<double, double> wilson(double successes, double count);

}  // namespace mh
