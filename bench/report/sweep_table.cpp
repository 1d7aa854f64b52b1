// SPDX-License-Identifier: Apache-2.0
#include "bench/report/sweep_table.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "bench/report/comparisons_text.hpp"
#include "bench/report/text_table.hpp"
#include "bench/report/wording.hpp"
#include "bench/results/sweep_results.hpp"
#include "slam/config/slam.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

std::string best_points(const Suite& suite, std::span<const Row> rows) {
  std::string text =
      "\nmost correct answers, and the difference to the suite's own settings, or to the first "
      "point "
      "(chosen by the same queries: confirm it on others)\n";
  for (const SweepResult& result : sweep_results(suite, rows))
    for (const QuerySet set : kQuerySets) {
      const auto best = best_point(suite, rows, result, set);
      if (!best) continue;
      const SystemSpec& system = suite.systems[result.system];
      const SlamConfig at = settings_of(system, result.points[best->point]);
      const Comparison& c = best->to_reference;
      if (best->equals == result.points.size()) {
        text += fmt::format("  {}, level {}, {}, {}: {:.2f}% at each of {} points\n", system.name,
                            level_name(suite.levels[result.level]), with_labels(result.labels),
                            name(set), 100 * *summary(result.answers[best->point], set).correct,
                            best->equals);
        continue;
      }
      text += fmt::format(
          "  {}, level {}, {}, {}: {}: {:.2f}%, {}{}\n", system.name,
          level_name(suite.levels[result.level]), with_labels(result.labels), name(set),
          shown_point(suite.sweep, at), 100 * *summary(result.answers[best->point], set).correct,
          c.pairs == 0 ? std::string("-") : fmt::format("{:+.4f} {}", c.difference, interval(c)),
          best->equals > 1 ? fmt::format("; {} points are equal", best->equals) : "");
    }
  return text;
}

/// Whether the sweep varies the weight of labels, as a factor (gamma) or as a share (label mass).
bool varies_weight_of_labels(const Sweep& sweep) {
  return std::ranges::any_of(sweep.varied, weighs_labels);
}

/// Adds the headings of up to two columns: if the label mass is varied, the gamma that gives the
/// requested mass; and the mass that labels then had in the queries.
void add_weight_headings(const Sweep& sweep, std::vector<std::string>& headings) {
  if (!varies_weight_of_labels(sweep)) return;
  if (std::ranges::count(sweep.varied, kLabelMass) > 0) headings.emplace_back("gamma");
  headings.emplace_back("measured mass");
}
void add_weight_cells(const Sweep& sweep, const QuerySummary& s, std::vector<std::string>& cells) {
  if (!varies_weight_of_labels(sweep)) return;
  if (std::ranges::count(sweep.varied, kLabelMass) > 0)
    cells.push_back(s.gamma ? fmt::format("{:.4g}", *s.gamma) : "-");
  cells.push_back(shown_mass(s));
}

/// The rows of the table for one level and one kind of labels.
std::string points_text(const Suite& suite, std::span<const CategoryRow> rows,
                        std::span<const CategoryRow> all) {
  std::vector<std::string> headings{"system"};
  for (const std::string& varied : suite.sweep.varied) headings.emplace_back(shown_name(varied));
  const bool maps = suite.sweep.map == SweepMap::kRebuilt;
  if (maps) std::ranges::move(trajectory_headings(), std::back_inserter(headings));
  for (const QuerySet set : kQuerySets) {
    if (!was_asked(all, set)) continue;
    std::ranges::move(query_headings(set), std::back_inserter(headings));
    headings.emplace_back("candidates");
    add_weight_headings(suite.sweep, headings);
  }
  TextTable table(std::move(headings));
  const std::vector<SharedSlamConfig> points = parameter_points(suite);
  for (const CategoryRow& row : rows) {
    const SystemSpec& system = suite.systems[row.system];
    const SlamConfig seen = settings_of(system, points[row.parameters]);
    std::vector<std::string> cells{system.name};
    for (const std::string& varied : suite.sweep.varied)
      cells.push_back(system.takes_settings() ? shown_value(seen, varied) : "-");
    if (maps) std::ranges::move(trajectory_cells(row), std::back_inserter(cells));
    for (const QuerySet set : kQuerySets) {
      if (!was_asked(all, set)) continue;
      std::ranges::move(query_cells(row, set), std::back_inserter(cells));
      const std::optional<double>& left = summary(row, set).final;
      cells.push_back(left ? fmt::format("{:.2f}", *left) : "-");
      add_weight_cells(suite.sweep, summary(row, set), cells);
    }
    table.add(std::move(cells), incomplete(row));
  }
  return table.text();
}

}  // namespace

std::string sweep_table(const Suite& suite, std::span<const Row> rows) {
  std::string text;
  std::vector<CategoryRow> all = make_category_rows(suite, rows);
  std::erase_if(all, [](const CategoryRow& row) { return row.category != kAllCategories; });
  for (auto first = all.begin(); first != all.end();) {
    const auto end = std::find_if(first, all.end(), [&](const CategoryRow& row) {
      return row.level != first->level || row.labels != first->labels;
    });
    text +=
        fmt::format("\n{}, level {}, {}, map: {}, {}{}\n", suite.name,
                    level_name(suite.levels[first->level]), with_labels(first->labels),
                    name(suite.sweep.map), counted(suite.trials, "trial"), shortened(suite, rows));
    text += points_text(suite, {first, end}, all);
    first = end;
  }
  return text + best_points(suite, rows);
}

}  // namespace mh
