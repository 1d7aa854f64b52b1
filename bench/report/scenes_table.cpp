// SPDX-License-Identifier: Apache-2.0
#include "bench/report/scenes_table.hpp"

#include <iterator>

#include <fmt/format.h>

#include "bench/report/comparisons_text.hpp"
#include "bench/report/text_table.hpp"
#include "bench/report/wording.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

/// The rows of the table for one level and one kind of labels.
std::string categories_text(const Suite& suite, std::span<const CategoryRow> rows,
                            std::span<const CategoryRow> all) {
  std::vector<std::string> headings{"environments", "system", "scenes"};
  std::ranges::move(trajectory_headings(), std::back_inserter(headings));
  for (const QuerySet set : kQuerySets)
    if (was_asked(all, set)) std::ranges::move(query_headings(set), std::back_inserter(headings));
  TextTable table(std::move(headings), 2);
  for (const CategoryRow& row : rows) {
    const SystemSpec& system = suite.systems[row.system];
    std::vector<std::string> cells{row.category, system.name, std::to_string(row.scenes)};
    std::ranges::move(trajectory_cells(row), std::back_inserter(cells));
    for (const QuerySet set : kQuerySets)
      if (was_asked(all, set)) std::ranges::move(query_cells(row, set), std::back_inserter(cells));
    const bool saturated = is_saturated(system, row);
    const std::string missing = incomplete(row);
    table.add(std::move(cells), !missing.empty() ? missing : saturated ? "saturated" : "");
  }
  return table.text();
}

}  // namespace

std::string scenes_table(const Suite& suite, std::span<const Row> rows, Extent extent) {
  std::string text;
  std::vector<CategoryRow> all = make_category_rows(suite, rows);
  if (extent == Extent::kScreen)
    std::erase_if(all, [](const CategoryRow& row) { return row.category != kAllCategories; });
  for (auto first = all.begin(); first != all.end();) {
    const auto end = std::find_if(first, all.end(), [&](const CategoryRow& row) {
      return row.level != first->level || row.labels != first->labels;
    });
    text += fmt::format(
        "\n{}, level {}, {}, {}{}; per scene the median over trials, then the mean over scenes\n",
        suite.name, level_name(suite.levels[first->level]), with_labels(first->labels),
        counted(suite.trials, "trial"), shortened(suite, rows));
    text += categories_text(suite, {first, end}, all);
    first = end;
  }
  if (extent == Extent::kScreen) return text;
  for (const SceneFamily& family : compare_over_scenes(suite, rows))
    text += comparisons_text(suite, family);
  return text;
}

}  // namespace mh
