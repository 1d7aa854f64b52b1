// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "bench/audit/write.hpp"
#include "bench/report/text_table.hpp"
#include "bench/report/wording.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

std::string percent(std::optional<double> share) {
  return share ? fmt::format("{:.1f}", 100 * *share) : "-";
}

std::string number(std::optional<double> value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

/// The columns that name a row in every table; level and settings are left out if they are the same
/// in all rows.
class Names {
 public:
  explicit Names(std::span<const AuditRow> rows) {
    for (const AuditRow& row : rows) {
      levels_ = levels_ || row.level != rows.front().level;
      settings_ = settings_ || row.settings != rows.front().settings;
    }
  }
  std::vector<std::string> headings() const {
    std::vector<std::string> names{"system", "labels", "queries"};
    if (settings_) names.insert(names.begin() + 2, "settings");
    if (levels_) names.insert(names.begin(), "level");
    return names;
  }
  std::vector<std::string> cells(const AuditRow& row) const {
    std::vector<std::string> names{row.system, row.labels, std::string(short_title(row.set))};
    if (settings_) names.insert(names.begin() + 2, row.settings);
    if (levels_) names.insert(names.begin(), row.level);
    return names;
  }

 private:
  bool levels_ = false, settings_ = false;
};

template <class Cells>
std::string table(std::string_view title, std::span<const AuditRow> rows,
                  const std::vector<std::string>& columns, Cells cells_of) {
  const Names names(rows);
  std::vector<std::string> headings = names.headings();
  const std::size_t left = headings.size();
  headings.insert(headings.end(), columns.begin(), columns.end());
  TextTable text(headings, left);
  for (const AuditRow& row : rows) {
    std::vector<std::string> cells = names.cells(row);
    const std::vector<std::string> figures = cells_of(row.summary);
    cells.insert(cells.end(), figures.begin(), figures.end());
    text.add(std::move(cells));
  }
  return fmt::format("\n{}\n{}", title, text.text());
}

std::string causes(std::span<const AuditRow> rows) {
  return table("answers, and the first cause of those that are not correct (first attempt, %)",
               rows,
               {"number", "all attempts", "correct", "wrong cand.", "not in sight", "few matches",
                "false", "few inliers"},
               [](const AuditSummary& s) {
                 return std::vector{std::to_string(s.queries),   percent(s.correct),
                                    percent(s.first_correct),    percent(s.wrong_candidates),
                                    percent(s.nothing_in_sight), percent(s.few_matches),
                                    percent(s.false_answer),     percent(s.few_inliers)};
               });
}

std::string ceilings(std::span<const AuditRow> rows) {
  return table(
      "ceilings (%): what would be correct, and what is correct of what could be", rows,
      {"correct", "nearest 5", "any keyframe", "no false match", "true pose", "correct / any"},
      [](const AuditSummary& s) {
        return std::vector{percent(s.first_correct),  percent(s.by_nearest),
                           percent(s.by_any),         percent(s.without_false),
                           percent(s.with_true_pose), percent(s.first_correct_of_solvable)};
      });
}

std::string retrieval(std::span<const AuditRow> rows) {
  return table(
      fmt::format("retrieval: a keyframe is relevant if it shows {:.0f} % of what the query sees",
                  100 * kRelevant),
      rows,
      {"mAP", "P@1", "P@5", "P@10", "R@5", "R@10", "candidates", "relevant %", "1st solves %",
       "one solves %", "rank", "m", "deg", "label mass %"},
      [](const AuditSummary& s) {
        return std::vector{number(s.average_precision, 3),
                           number(s.precision_1, 3),
                           number(s.precision_5, 3),
                           number(s.precision_10, 3),
                           number(s.recall_5, 3),
                           number(s.recall_10, 3),
                           number(s.candidates, 2),
                           percent(s.relevant_candidates),
                           percent(s.first_candidate_solves),
                           percent(s.candidate_solves),
                           number(s.solving_rank, 0),
                           number(s.solving_m, 2),
                           number(s.solving_deg, 0),
                           percent(s.label_mass)};
      });
}

std::string_view title(MatchStage stage) {
  switch (stage) {
    case MatchStage::kWords:
      return "by words with the candidates that were tried";
    case MatchStage::kGuided:
      return "guided by a first pose";
    case MatchStage::kLocalMap:
      return "in the local map";
    case MatchStage::kEveryKeyframe:
      break;
  }
  return "by words with every keyframe of the map";
}

std::string differ(std::int64_t part, std::int64_t all) {
  if (all == 0) return "-";
  return percent(static_cast<double>(part) / static_cast<double>(all));
}

std::string matches(std::span<const AuditRow> rows) {
  std::string text;
  for (const MatchStage stage : kMatchStages)
    text += table(
        fmt::format("matches {}: with equation 2 and as they would be at xi = 1", title(stage)),
        rows,
        {"kept right", "wrong", "precision", "at 1", "recall", "at 1", "right lost", "threshold",
         "ratio", "other", "border", "label error", "void", "wrong removed", "right differ %",
         "wrong differ %"},
        [&](const AuditSummary& s) {
          const StageMatches& m = s.matches[static_cast<std::size_t>(stage)];
          return std::vector{std::to_string(m.with_xi.kept_right()),
                             std::to_string(m.with_xi.kept_wrong()),
                             number(m.with_xi.precision(), 3),
                             number(m.without_xi.precision(), 3),
                             number(m.with_xi.recall(), 3),
                             number(m.without_xi.recall(), 3),
                             std::to_string(m.xi.right_lost()),
                             std::to_string(m.xi.lost_to_threshold),
                             std::to_string(m.xi.lost_to_ratio),
                             std::to_string(m.xi.lost_to_another),
                             std::to_string(m.xi.lost_at_border),
                             std::to_string(m.xi.lost_by_label_error),
                             std::to_string(m.xi.lost_by_void),
                             std::to_string(m.xi.wrong_removed),
                             differ(m.xi.right_differ, m.without_xi.kept_right()),
                             differ(m.xi.wrong_differ, m.without_xi.kept_wrong())};
        });
  return text;
}

std::string cost(std::span<const AuditedRun> runs) {
  double audit_s = 0, run_s = 0;
  std::size_t queries_audited = 0, from_cache = 0;
  for (const AuditedRun& run : runs) {
    audit_s += run.audit.audit_s;
    run_s += run.audit.run_s;
    from_cache += run.audit.map_from_cache ? 1 : 0;
    for (const PointAudit& point : run.audit.points)
      for (const QuerySet set : kQuerySets) queries_audited += queries(point, set).size();
  }
  if (queries_audited == 0) return "\nno query was audited\n";
  return fmt::format(
      "\nthe audit took {:.2f} s of CPU time per query ({}), {:.0f} % of what the {} took{}\n",
      audit_s / static_cast<double>(queries_audited), counted(queries_audited, "query", "queries"),
      100 * audit_s / run_s, runs.size() == 1 ? "run" : "runs",
      from_cache > 0 ? fmt::format(", {} of them with a map from the cache", from_cache) : "");
}

}  // namespace

std::string audit_text(const Suite& suite, std::span<const AuditedRun> runs) {
  const std::vector<AuditRow> rows = audit_rows(suite, runs);
  return causes(rows) + ceilings(rows) + retrieval(rows) + matches(rows) + cost(runs);
}

}  // namespace mh
