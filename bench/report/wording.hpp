// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/results/scenes.hpp"

namespace mh {

// Text that the tables of results share.

/// If a system answers more than this share of the queries with a pose (a correct one, where that
/// is known), there is effectively nothing left to gain.
inline constexpr double kSaturated = 0.97;

/// Whether a system without labels is saturated: it answers so many queries with a pose (a correct
/// one, where that is known) that labels could gain nothing.
bool is_saturated(const SystemSpec& system, const QuerySummary& queries);
/// The same for a row as a whole: every set of queries that was asked is saturated.
bool is_saturated(const SystemSpec& system, const CategoryRow& row);

/// "held out", "2nd tour", "graded"
std::string_view short_title(QuerySet set);

/// ", first 200 frames" if the tours were cut; empty otherwise.
std::string shortened(const Suite& suite, std::span<const Row> rows);

/// "2 of 3 trials, 1 failed" for a row that lacks trials; empty otherwise.
std::string incomplete(const Suite& suite, const Row& row);
/// The same for scenes: "1 of 2 scenes, 3 runs failed".
std::string incomplete(const CategoryRow& row);

/// Whether this row was already shown with an earlier kind of labels: a system that sees no labels
/// runs once and is shown with each kind.
bool already_shown(const Suite& suite, const Row& row);

/// Headings of the columns that summarize a trajectory, and of those that summarize queries.
std::vector<std::string> trajectory_headings();
std::vector<std::string> query_headings(QuerySet set);
/// Cells for these columns; "-" if there were no queries.
std::vector<std::string> trajectory_cells(const CategoryRow& row);
/// @param known  false: "-" in each cell
std::vector<std::string> trajectory_cells(const TrajectoryScore& score, bool known);
std::vector<std::string> query_cells(const CategoryRow& row, QuerySet set);

/// The mean share of a query's vector that labels make up, as "17.2%"; "-" if unknown.
std::string shown_mass(const QuerySummary& summary);

/// Whether there were any queries of the set in these rows.
bool was_asked(std::span<const CategoryRow> rows, QuerySet set);

}  // namespace mh
