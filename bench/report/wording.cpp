// SPDX-License-Identifier: Apache-2.0
#include "bench/report/wording.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "slam/io/counted.hpp"

namespace mh {
namespace {

std::vector<std::string> overview_cells(const std::vector<Figure>& figures, bool known) {
  std::vector<std::string> cells;
  for (const Figure& figure : figures)
    if (figure.metric.in_overview) cells.push_back(known ? shown(figure) : "-");
  return cells;
}

template <class Score>
std::vector<std::string> overview_headings() {
  std::vector<std::string> headings;
  for (const Figure& figure : figures_of(Score()))
    if (figure.metric.in_overview) headings.emplace_back(figure.metric.heading);
  return headings;
}

}  // namespace

std::string_view short_title(QuerySet set) {
  return set == QuerySet::kHeldOut      ? "held out"
         : set == QuerySet::kSecondTour ? "2nd tour"
                                        : "graded";
}

std::string shortened(const Suite& suite, std::span<const Row> rows) {
  const bool cut = std::ranges::any_of(rows, [](const Row& row) {
    return std::ranges::any_of(row.trials, [](const Trial& t) { return t.run->place.cut; });
  });
  return cut ? fmt::format(", first {}", counted(*suite.max_frames, "frame")) : "";
}

std::string incomplete(const Suite& suite, const Row& row) {
  const auto all = static_cast<std::size_t>(suite.trials);
  if (row.trials.size() == all) return "";
  if (row.trials.empty())
    return all == 1 ? "failed" : fmt::format("failed: {} of {} trials", row.failed, all);
  return fmt::format("{} of {}{}", row.trials.size(), counted(all, "trial"),
                     row.failed > 0 ? fmt::format(", {} failed", row.failed) : "");
}

std::string incomplete(const CategoryRow& row) {
  std::string text;
  if (row.scenes < row.of) text = fmt::format("{} of {}", row.scenes, counted(row.of, "scene"));
  if (row.failed > 0)
    text += fmt::format("{}{} failed", text.empty() ? "" : ", ", counted(row.failed, "run"));
  return text;
}

bool is_saturated(const SystemSpec& system, const QuerySummary& queries) {
  return !system.sees_labels() && queries.success > kSaturated &&
         queries.correct.value_or(1) > kSaturated;
}

bool is_saturated(const SystemSpec& system, const CategoryRow& row) {
  bool asked = false;
  for (const QuerySet set : kQuerySets) {
    if (summary(row, set).queries == 0) continue;
    if (!is_saturated(system, summary(row, set))) return false;
    asked = true;
  }
  return asked;
}

bool already_shown(const Suite& suite, const Row& row) {
  const auto first = std::ranges::find_if(suite.labels, [&](const Labels& labels) {
    return fits(suite.environments[row.environment], labels);
  });
  return !suite.systems[row.system].sees_labels() && row.labels != *first;
}

std::vector<std::string> trajectory_headings() {
  return overview_headings<TrajectoryScore>();
}

std::vector<std::string> query_headings(QuerySet set) {
  std::vector<std::string> headings = overview_headings<QuerySummary>();
  headings.front() = fmt::format("{}: {}", short_title(set), headings.front());
  return headings;
}

std::vector<std::string> trajectory_cells(const CategoryRow& row) {
  return trajectory_cells(row.trajectory, row.scenes > 0);
}
std::vector<std::string> trajectory_cells(const TrajectoryScore& score, bool known) {
  return overview_cells(figures_of(score), known);
}

std::vector<std::string> query_cells(const CategoryRow& row, QuerySet set) {
  return overview_cells(figures_of(summary(row, set)), summary(row, set).queries > 0);
}

std::string shown_mass(const QuerySummary& summary) {
  return summary.label_mass ? fmt::format("{:.1f}%", 100 * *summary.label_mass) : "-";
}

bool was_asked(std::span<const CategoryRow> rows, QuerySet set) {
  return std::ranges::any_of(rows,
                             [&](const CategoryRow& row) { return summary(row, set).queries > 0; });
}

}  // namespace mh
