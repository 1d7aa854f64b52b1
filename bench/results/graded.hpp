// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/results/scenes.hpp"

namespace mh {

/// One system's answers to the graded queries of one bin, over scenes and trials.
struct GradedShare {
  double success = 0, correct = 0, false_positive = 0;  ///< shares
  /// 95 % interval of success, as if queries were independent (Wilson, 1927).
  double low = 0, high = 1;
};

/// The graded queries between two edges of the quantity that they are graded by.
struct GradedBin {
  double low = 0, high = 0;
  std::size_t queries = 0;  ///< over scenes; each is made in every trial
  std::vector<std::optional<GradedShare>> systems = {};  ///< by system; absent if it has no answers
  /// Success of the suite's first pair of systems over the same queries, first minus second: with
  /// scenes as clusters if there are four, else by blocks of queries.
  std::optional<Comparison> difference = {};
};

/// Success as a function of a quantity that queries are graded by.
struct GradedCurve {
  std::size_t level = 0;
  Labels labels;
  std::string category;  ///< of the scenes; kAllCategories
  std::string by, unit;  ///< "distance", "m"
  std::vector<GradedBin> bins;
};

/// Curves at the suite's first parameter point, per level and kind of labels: over distance and
/// angle to the nearest mapped view, over the share of the view that the map shows and, if there
/// are several speeds, over speed; for a suite with several categories, also over distance within
/// each. Empty without graded queries.
std::vector<GradedCurve> graded_curves(const Suite& suite, std::span<const Row> rows);

/// How many views were drawn in a suite's scenes, and how many of them were not queried because no
/// mapped frame shows them.
struct GradedDraws {
  std::size_t asked = 0, hidden = 0;
  std::size_t short_cells = 0, cells = 0;  ///< bins with fewer queries than wanted, and all bins
};
GradedDraws graded_draws(const Suite& suite, std::span<const Row> rows);

/// Wilson's interval of a share (Wilson, 1927), 95 %.
std::pair<double, double> wilson(double successes, double count);

}  // namespace mh
