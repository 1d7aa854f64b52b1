// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/results/scenes.hpp"

namespace mh {

// Text that the tables of results share.

/// Above this share of queries answered with a pose (a correct one, where that is known), nothing
/// is left to gain.
inline constexpr double kSaturated = 0.97;

/// Whether a system without labels returns a pose for so many queries, correct as far as is known,
/// that labels have nothing left to gain.
bool is_saturated(const SystemSpec& system, const QuerySummary& queries);
/// The same for all sets of queries that were asked.
bool is_saturated(const SystemSpec& system, const CategoryRow& row);

/// "held out", "2nd tour", "graded"
std::string_view short_title(QuerySet set);

/// ", first 200 frames" if the tours were cut; empty otherwise.
std::string shortened(const Suite& suite, std::span<const Row> rows);

/// "2 of 3 trials, 1 failed" for a row that lacks some; empty otherwise.
std::string incomplete(const Suite& suite, const Row& row);
/// The same for scenes: "1 of 2 scenes, 3 runs failed".
std::string incomplete(const CategoryRow& row);

/// Whether this row was already shown with an earlier kind of labels: a system that sees no labels
/// runs once and is shown with each kind.
bool already_shown(const Suite& suite, const Row& row);

/// Headings of the columns that summarize a trajectory, and of those that summarize queries.
std::vector<std::string> trajectory_headings();
std::vector<std::string> query_headings(QuerySet set);
/// Their cells; "-" if there were no queries.
std::vector<std::string> trajectory_cells(const CategoryRow& row);
std::vector<std::string> query_cells(const CategoryRow& row, QuerySet set);

/// The share of the queries' vectors that labels make up, "17.2%"; "-" if unknown.
std::string shown_mass(const QuerySummary& summary);

/// Whether any of the rows answered queries of the set.
bool was_asked(std::span<const CategoryRow> rows, QuerySet set);

}  // namespace mh
