// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <nlohmann/json.hpp>

#include "bench/report/pages/source.hpp"
#include "bench/results/scenes.hpp"

namespace mh {

/// A system with the labels that it sees. Pages and plots call it "semantic, exact", or just
/// "semantic" if there is only one kind of labels.
struct Arm {
  std::size_t system = 0;
  std::string labels, name;
};
/// The arms of a suite in its order, which determines their colors.
std::vector<Arm> arms_of(const Suite& suite);

/// The labels that a system sees: "none" if it looks at none.
std::string labels_seen(const Suite& suite, std::size_t system, const Labels& labels);

/// Whether a row has answers of its own rather than those of an earlier row: a system that sees no
/// labels has the same answers in the rows of every kind of labels.
bool is_own_row(const Suite& suite, std::size_t system, const Labels& labels);

/// Definitions of the terms in the tables, with the suite's thresholds.
std::string definitions_text(const Suite& suite);

/// The paper's Table 1: a row per category and system; null for a suite of one environment.
nlohmann::ordered_json table1_json(const Suite& suite, std::span<const CategoryRow> rows);

/// The paper's Table 2: a row per level, labels, query set and system. The published figures are
/// included if the suite names them (`published`).
nlohmann::ordered_json table2_json(const Suite& suite, std::span<const CategoryRow> rows);

/// ATE by environment beside the published ATE; null unless the suite states published values.
nlohmann::ordered_json published_ate_json(const Suite& suite, std::span<const Row> rows);

/// A row per variant and system: success of the kidnapped robots; null without episodes.
nlohmann::ordered_json episodes_page_json(const Suite& suite, std::span<const RunResult> runs);

/// Section 3.3.3 of the paper: keyframes left after each step of Algorithm 1, as shares. The
/// published shares are included if the suite names them.
nlohmann::ordered_json candidates_json(const Suite& suite, std::span<const CategoryRow> rows);

/// A row per run: what it is, whether it failed, every metric at its first point, its cost.
nlohmann::ordered_json runs_json(const PagesSource& source);

/// The pose of an answer in the frame of the truth. As in scoring (docs/protocol.md), it is
/// relative to the nearest mapped frame, so that its distance from the query's true pose is its
/// error. nullopt if the query was not answered, or if nothing was mapped that the answer could be
/// compared with.
std::optional<SE3> answer_in_truth(const RunResult& run, QuerySet set, const QueryScore& query);

/// A row per query of every run and point, with the cause of its failure if an audit states one.
/// @param only  list only this run's queries; null: those of all runs
nlohmann::ordered_json queries_json(const PagesSource& source, const RunResult* only = nullptr);

/// The rows of audit.json, and separately its rows for single environments; null without an audit.
nlohmann::ordered_json audit_tables_json(const PagesSource& source);

}  // namespace mh
