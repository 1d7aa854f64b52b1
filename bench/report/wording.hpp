// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/results/scenes.hpp"

namespace mh {

// What the tables of results have in common.

/// Above this share of successes of a system without labels nothing is left to be gained by them.
inline constexpr double kSaturated = 0.97;

/// "held out", "2nd tour"
std::string_view short_title(QuerySet set);

/// ", first 200 frames" behind what was cut; empty otherwise.
std::string shortened(const Suite& suite, std::span<const Row> rows);

/// "2 of 3 trials, 1 failed" of a row that lacks some; empty otherwise.
std::string incomplete(const Suite& suite, const Row& row);
/// The same of scenes: "1 of 2 scenes, 3 runs failed".
std::string incomplete(const CategoryRow& row);

/// A system that sees no labels runs once and stands beside each kind of labels: whether this row
/// stood with an earlier kind already.
bool already_shown(const Suite& suite, const Row& row);

/// Headings of the figures that stand in an overview of a trajectory, of answers.
std::vector<std::string> trajectory_headings();
std::vector<std::string> query_headings(QuerySet set);
/// Their cells; "-" where nothing was asked.
std::vector<std::string> trajectory_cells(const CategoryRow& row);
std::vector<std::string> query_cells(const CategoryRow& row, QuerySet set);

/// Whether any of the rows answered queries of the set.
bool was_asked(std::span<const CategoryRow> rows, QuerySet set);

}  // namespace mh
