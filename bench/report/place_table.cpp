// SPDX-License-Identifier: Apache-2.0
#include "bench/report/place_table.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "bench/report/comparisons_text.hpp"
#include "bench/report/table2.hpp"
#include "bench/report/text_table.hpp"
#include "bench/report/wording.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

/// Rows that differ only in the system.
struct Block {
  const Suite& suite;
  std::span<const Row> all;  ///< rows of the whole table
  std::vector<const Row*> rows;
  std::vector<const Row*> detailed;  ///< rows that were not already shown with other labels
  const SystemSpec& system(const Row* row) const { return suite.systems[row->system]; }
};

std::string meters(const std::optional<double>& value) {
  return value ? fmt::format("{:.4f}", *value) : std::string("-");
}

/// The number of queries of a set; if systems differ, that of the system with the most queries.
double most_queries(const Block& block, QuerySet set) {
  double most = 0;
  for (const Row* row : block.rows) most = std::max(most, summary(*row, set).queries);
  return most;
}

std::string title(QuerySet set) {
  return set == QuerySet::kHeldOut      ? "held-out frames (the paper's way)"
         : set == QuerySet::kSecondTour ? "second tour"
                                        : "graded by distance and angle";
}

/// A row of Table 2 as text, with value(column) in each of its columns.
template <class Value>
std::vector<std::string> paper_row(std::string_view title, const Value& value) {
  std::vector<std::string> cells{fmt::format("  {}", title)};
  for (const Table2Column& column : kTable2Columns) {
    if (column.text_heading.empty()) continue;
    cells.push_back(shown(column, value(column)));
  }
  return cells;
}

std::vector<std::string> paper_headings() {
  std::vector<std::string> headings{""};
  for (const Table2Column& column : kTable2Columns)
    if (!column.text_heading.empty()) headings.emplace_back(column.text_heading);
  return headings;
}

/// The table in the form of the paper's Table 2. Empty if there were no queries, as in a suite that
/// only scores trajectories of outside programs.
/// @param published  the paper's own rows; empty if they are shown elsewhere
std::string paper_table(const Block& block, std::span<const PublishedRow> published) {
  const auto asked = [&](QuerySet set) { return most_queries(block, set) > 0; };
  if (published.empty() && std::ranges::none_of(kQuerySets, asked)) return "";
  TextTable table(paper_headings());
  for (const QuerySet set : kQuerySets) {
    if (!asked(set)) continue;
    table.add_line(fmt::format("{}, {}", title(set),
                               counted(std::lround(most_queries(block, set)), "query", "queries")));
    for (const Row* row : block.rows) {
      const QuerySummary& s = summary(*row, set);
      const bool saturated = is_saturated(block.system(row), s);
      std::string missing = incomplete(block.suite, *row);
      if (missing.empty() && block.system(row).is_asked() && s.queries < most_queries(block, set))
        missing = fmt::format("{:.0f} of them", s.queries);
      table.add(paper_row(block.system(row).name,
                          [&](const Table2Column& column) {
                            return s.queries > 0 ? column.measured(s) : std::nullopt;
                          }),
                !missing.empty() ? missing
                : saturated      ? "saturated"
                                 : "");
    }
  }
  if (!published.empty()) {
    table.add_line(
        "published, other data (the paper's Table 2: a real house of 60 m2, YOLOv3 boxes)");
    for (const PublishedRow& row : published)
      table.add(paper_row(row.system, [&](const Table2Column& column) {
        return column.published != nullptr ? std::optional(row.*column.published) : std::nullopt;
      }));
    table.add_line("  (as released, ORB-SLAM2's answers depend on the order of its queries)");
  }
  const std::string text = table.text();
  const std::string rule = std::string(text.find('\n'), '-') + "\n";  // as wide as the headings
  return rule + text + rule;
}

/// A title, followed by the headings of the figures that these scores have.
template <class... Scores>
std::vector<std::string> headings(std::string title) {
  std::vector<std::string> all{std::move(title)};
  const auto add = [&](const std::vector<Figure>& figures) {
    for (const Figure& figure : figures)
      if (!figure.metric.heading.empty()) all.emplace_back(figure.metric.heading);
  };
  (add(figures_of(Scores())), ...);
  return all;
}

/// Appends the figures that have a heading; "-" if unknown.
void add_cells(const std::vector<Figure>& figures, bool known, std::vector<std::string>& cells) {
  for (const Figure& figure : figures)
    if (!figure.metric.heading.empty()) cells.push_back(known ? shown(figure) : "-");
}

std::string query_details(const Block& block, QuerySet set) {
  TextTable table(headings<QuerySummary>(std::string(short_title(set))));
  for (const Row* row : block.detailed) {
    const QuerySummary& s = summary(*row, set);
    std::vector<std::string> cells{block.system(row).name};
    add_cells(figures_of(s), s.queries > 0, cells);
    table.add(std::move(cells));
  }
  return table.text();
}

/// Keyframes left after each step of Algorithm 1, as counts and as shares of the map; "-" if a
/// program did not report them.
std::string candidate_details(const Block& block, QuerySet set) {
  TextTable table({std::string(short_title(set)), "keyframes", "after eq. 3", "after eq. 4",
                   "after eq. 5", "after eq. 6", "one left", "label mass"});
  for (const Row* row : block.detailed) {
    const QuerySummary& s = summary(*row, set);
    if (s.queries == 0) continue;
    const auto left = [&](const std::optional<double>& count) {
      if (!count) return std::string("-");
      if (!s.keyframes) return fmt::format("{:.2f}", *count);
      return fmt::format("{:.2f} ({:.2f}%)", *count, 100 * *count / std::max(1.0, *s.keyframes));
    };
    const auto share = [](const std::optional<double>& value) {
      return value ? fmt::format("{:.1f}%", 100 * *value) : std::string("-");
    };
    table.add({block.system(row).name, s.keyframes ? fmt::format("{:.0f}", *s.keyframes) : "-",
               left(s.c1), left(s.c2), left(s.c3), left(s.final), share(s.single_candidate),
               share(s.label_mass)});
  }
  return table.text();
}

std::string failing_stages(const Block& block) {
  std::string text;
  for (const Row* row : block.detailed)
    for (const QuerySet set : kQuerySets) {
      std::map<std::optional<RelocalizationStage>, int> stages;
      for (const Trial& trial : row->trials)
        for (const QueryScore& q : queries(*trial.point, set))
          if (!q.success) ++stages[q.answer.stage];
      if (stages.empty()) continue;
      text += fmt::format("  {}, {}: unanswered, by the stage reached:", block.system(row).name,
                          name(set));
      const char* comma = "";
      for (const auto& [stage, count] : stages) {
        text += fmt::format("{} {} {}", comma, count, stage ? name(*stage) : "not reported");
        comma = ",";
      }
      text += "\n";
    }
  return text;
}

std::string mapping_details(const Block& block) {
  TextTable table(headings<TrajectoryScore, MappingCounts>("mapping"));
  for (const Row* row : block.detailed) {
    std::vector<std::string> cells{block.system(row).name};
    const bool known = !row->trials.empty();
    add_cells(figures_of(row->trajectory), known, cells);
    add_cells(figures_of(row->mapping), known, cells);
    table.add(std::move(cells), incomplete(block.suite, *row));
  }
  return table.text();
}

/// The same for a screen: the figures of overviews alone.
std::string mapping_overview(const Block& block) {
  std::vector<std::string> names = trajectory_headings();
  names.insert(names.begin(), "mapping");
  TextTable table(std::move(names));
  for (const Row* row : block.detailed) {
    std::vector<std::string> cells = trajectory_cells(row->trajectory, !row->trials.empty());
    cells.insert(cells.begin(), block.system(row).name);
    table.add(std::move(cells), incomplete(block.suite, *row));
  }
  return table.text();
}

/// The effect of xi, for each matcher.
std::string penalties(const Block& block) {
  std::string text;
  for (const Row* row : block.rows) {
    if (!block.system(row).weighs_labels() || !row->matches) continue;
    TextTable table({"descriptor pairs", "compared", "labels differ", "rejected by it",
                     "ratio tests it helped"});
    for (std::size_t m = 0; m < row->matches->size(); ++m) {
      const MatcherCounts& c = (*row->matches)[m];
      const double share = c.compared > 0 ? 100.0 * static_cast<double>(c.penalized) /
                                                static_cast<double>(c.compared)
                                          : 0.0;
      table.add({std::string(name(static_cast<Matcher>(m))), std::to_string(c.compared),
                 fmt::format("{} ({:.1f}%)", c.penalized, share), std::to_string(c.rejected_by_xi),
                 std::to_string(c.ratio_helped)});
    }
    text += table.text();
  }
  return text;
}

std::string common_ate(const Block& block) {
  std::string text;
  for (const auto& [first, second] : block.suite.compare) {
    const auto row_of = [&](std::size_t system) -> const Row* {
      const auto row = std::ranges::find_if(
          block.rows, [&](const Row* r) { return r->system == system && !r->trials.empty(); });
      return row == block.rows.end() ? nullptr : *row;
    };
    const Row *one = row_of(first), *other = row_of(second);
    if (one == nullptr || other == nullptr) continue;
    const auto [a, b] = ate_over_common_frames(*one, *other);
    text += fmt::format("  ATE over the frames that both tracked, m: {} {}, {} {}\n",
                        block.system(one).name, meters(a), block.system(other).name, meters(b));
  }
  return text;
}

std::string block_text(const Block& block, Extent extent, bool is_first) {
  const Suite& suite = block.suite;
  const Row& row = *block.rows.front();
  std::string text = fmt::format(
      "\n{}, level {}, {}, {}{}{}\n",
      suite.environments.size() > 1 ? suite.environments[row.environment].name : suite.name,
      level_name(suite.levels[row.level]), with_labels(row.labels), counted(suite.trials, "trial"),
      suite.trials == 1 ? "" : " (medians)", shortened(suite, block.all));
  text += paper_table(block, is_first ? published_rows(suite) : std::span<const PublishedRow>());
  if (extent == Extent::kScreen) return text + mapping_overview(block);
  for (const QuerySet set : kQuerySets)
    if (most_queries(block, set) > 0)
      text += query_details(block, set) + candidate_details(block, set);
  text += failing_stages(block) + mapping_details(block);
  if (block.detailed.size() < block.rows.size())
    text +=
        "  plain: the same runs as above, since it ignores labels; their details are shown there\n";
  return text + common_ate(block) + penalties(block);
}

}  // namespace

std::string place_table(const Suite& suite, std::span<const Row> rows, Extent extent) {
  std::string text;
  for (auto first = rows.begin(); first != rows.end();) {
    Block block{suite, rows, {}, {}};
    auto end = first;
    for (; end != rows.end() && end->level == first->level && end->labels == first->labels; ++end) {
      block.rows.push_back(&*end);
      if (!already_shown(suite, *end)) block.detailed.push_back(&*end);
    }
    text += block_text(block, extent, first == rows.begin());
    first = end;
  }
  if (extent == Extent::kScreen) return text;
  for (const Family& family : compare_systems(suite, rows)) text += comparisons_text(suite, family);
  return text;
}

}  // namespace mh
