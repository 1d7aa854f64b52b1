// SPDX-License-Identifier: Apache-2.0
#include "bench/results/sweep_results.hpp"
#include "slam/config/slam.hpp"

#include <algorithm>

namespace mh {
namespace {

/// The rows of a result's system at one point, one per environment that has one.
std::vector<const Row*> rows_at(std::span<const Row> rows, const SweepResult& result,
                                std::size_t point) {
  std::vector<const Row*> found;
  for (const Row& row : rows)
    if (row.level == result.level && row.system == result.system && row.labels == result.labels &&
        row.parameters == point && !row.trials.empty())
      found.push_back(&row);
  return found;
}

}  // namespace

std::vector<SweepResult> sweep_results(const Suite& suite, std::span<const Row> rows) {
  const std::vector<SharedSlamConfig> points = parameter_points(suite);
  std::vector<SweepResult> results;
  for (const CategoryRow& row : make_category_rows(suite, rows)) {
    if (row.category != kAllCategories || row.scenes == 0) continue;
    auto result = std::ranges::find_if(results, [&](const SweepResult& r) {
      return r.level == row.level && r.system == row.system && r.labels == row.labels;
    });
    if (result == results.end())
      result = results.insert(results.end(), {row.level, row.system, row.labels, {}, {}});
    result->points.push_back(points[row.parameters]);
    result->answers.push_back(row);
  }
  std::erase_if(results, [&](const SweepResult& result) {
    const SystemSpec& system = suite.systems[result.system];
    return std::ranges::all_of(result.points, [&](const SlamConfig& point) {
      return settings_of(system, point) == settings_of(system, result.points.front());
    });
  });
  return results;
}

std::optional<BestPoint> best_point(const Suite& suite, std::span<const Row> rows,
                                    const SweepResult& result, QuerySet set) {
  if (result.answers.empty() || !summary(result.answers.front(), set).correct) return std::nullopt;
  // A point that failed in some scenes could be compared only on the others, so it is never best.
  const std::size_t scenes =
      std::ranges::max_element(result.answers, {}, &CategoryRow::scenes)->scenes;
  const auto correct = [&](const CategoryRow& row) {
    return row.scenes == scenes ? summary(row, set).correct.value_or(-1.0) : -1.0;
  };
  const auto own = std::ranges::find(result.points, suite.slam);
  BestPoint found;
  if (own != result.points.end())
    found.reference = static_cast<std::size_t>(own - result.points.begin());
  const CategoryRow& reference = result.answers[found.reference];
  auto best = std::ranges::max_element(result.answers, {}, correct);
  found.equals =
      static_cast<std::size_t>(std::ranges::count(result.answers, correct(*best), correct));
  if (correct(reference) == correct(*best))
    best = result.answers.begin() + static_cast<std::ptrdiff_t>(found.reference);
  found.point = static_cast<std::size_t>(best - result.answers.begin());
  const std::vector<const Row*> at_best = rows_at(rows, result, best->parameters);
  const std::vector<const Row*> at_reference = rows_at(rows, result, reference.parameters);
  if (at_best.size() == 1 && at_reference.size() == 1) {
    found.to_reference = compare_correct(*at_best.front(), *at_reference.front(), set, suite.seed);
    return found;
  }
  std::vector<PairedDifference> differences;
  std::size_t answers = 0;
  for (const Row* a : at_best)
    for (const Row* b : at_reference) {
      if (a->environment != b->environment) continue;
      differences.push_back(paired_difference(summary(*a, set).correct, summary(*b, set).correct));
      answers += shared_queries(*a, *b, set);
    }
  found.to_reference = compare_scenes(differences, answers, suite.seed);
  return found;
}

}  // namespace mh
