// SPDX-License-Identifier: Apache-2.0
#include "bench/results/scenes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace mh {
namespace {

std::optional<double> mean_of_known(std::span<const std::optional<double>> values) {
  std::vector<double> known;
  for (const auto& value : values)
    if (value) known.push_back(*value);
  return known.empty() ? std::nullopt : std::optional(mean(known));
}

QuerySummary mean_summary(const std::vector<const Row*>& scenes, QuerySet set) {
  std::vector<QuerySummary> all;
  for (const Row* row : scenes)
    if (summary(*row, set).queries > 0) all.push_back(summary(*row, set));
  return reduce(std::span(std::as_const(all)), mean_of_known);
}

bool has_result(const Row* row) {
  return row != nullptr && !row->trials.empty();
}

/// @param scenes  at least one; a scene whose runs all failed is only counted
/// @param of      number of scenes of the category in the suite
CategoryRow together(std::string category, std::vector<const Row*> scenes, std::size_t of) {
  const Row& any = *scenes.front();
  CategoryRow c;
  c.category = std::move(category);
  c.of = of;
  for (const Row* row : scenes) c.failed += row->failed;
  std::erase_if(scenes, [](const Row* row) { return !has_result(row); });
  c.level = any.level;
  c.system = any.system;
  c.parameters = any.parameters;
  c.labels = any.labels;
  c.scenes = scenes.size();
  std::vector<TrajectoryScore> trajectories;
  for (const Row* row : scenes) trajectories.push_back(row->trajectory);
  c.trajectory = reduce(std::span(std::as_const(trajectories)), mean_of_known);
  for (const QuerySet set : kQuerySets) of_query_set(c, set) = mean_summary(scenes, set);
  return c;
}

std::vector<std::string> categories(const Suite& suite) {
  std::vector<std::string> names;
  for (const Environment& e : suite.environments)
    if (std::find(names.begin(), names.end(), e.category) == names.end())
      names.push_back(e.category);
  return names;
}

/// One system's rows, by environment; null for an environment without one.
std::vector<const Row*> scenes_of(const Suite& suite, std::span<const Row> rows, std::size_t level,
                                  const Labels& labels, std::size_t parameters,
                                  std::size_t system) {
  std::vector<const Row*> scenes(suite.environments.size(), nullptr);
  for (const Row& row : rows)
    if (row.level == level && row.labels == labels && row.parameters == parameters &&
        row.system == system)
      scenes[row.environment] = &row;
  return scenes;
}

/// Returns first minus second in one scene.
using Difference = PairedDifference (*)(const Row&, const Row&, QuerySet);

template <auto QuerySummary::*kField>
PairedDifference share(const Row& a, const Row& b, QuerySet set) {
  if (summary(a, set).queries == 0 || summary(b, set).queries == 0) return {};
  return paired_difference(summary(a, set).*kField, summary(b, set).*kField);
}

PairedDifference distance(const Row& a, const Row& b, QuerySet set) {
  const Comparison c = compare_distances(a, b, set);
  return c.pairs > 0 ? PairedDifference{c.difference, true} : PairedDifference{};
}

PairedDifference ate(const Row& a, const Row& b, QuerySet) {
  const auto [first, second] = ate_over_common_frames(a, b);
  return paired_difference(first, second);
}

std::vector<Comparison> compare(const std::vector<const Row*>& first,
                                const std::vector<const Row*>& second, const Labels& labels,
                                const Suite& suite) {
  const std::uint64_t seed = suite.seed;
  std::vector<Comparison> comparisons;
  const auto add = [&](const Compared& what, Difference between_rows, QuerySet set,
                       bool more_is_better, bool in_family) {
    const bool shares = what.unit.empty();
    std::vector<PairedDifference> differences;
    std::size_t answers = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (!has_result(first[i]) || !has_result(second[i])) continue;
      differences.push_back(between_rows(*first[i], *second[i], set));
      if (shares && differences.back().present)
        answers += shared_queries(*first[i], *second[i], set);
    }
    comparisons.push_back(compare_scenes(differences, answers, seed));
    comparisons.back().what = what;
    comparisons.back().more_is_better = more_is_better;
    comparisons.back().in_family = in_family;
    if (comparisons.back().pairs == 0) comparisons.pop_back();
  };
  const auto add_pooled = [&](const Compared& what, auto pairs_of, QuerySet set) {
    std::vector<std::vector<PairedDifference>> scenes;
    for (std::size_t i = 0; i < first.size(); ++i)
      if (has_result(first[i]) && has_result(second[i]))
        scenes.push_back(pairs_of(*first[i], *second[i], set));
    comparisons.push_back(compare_clusters(scenes, true, seed));
    comparisons.back().what = what;
    comparisons.back().in_family = false;
    if (comparisons.back().pairs == 0) comparisons.pop_back();
  };
  for (const QuerySet set : kQuerySets) {
    const auto what = [&](const char* measure, const char* unit = "") {
      return Compared{measure, unit, std::string(name(set)), with_labels(labels)};
    };
    add(what("success"), share<&QuerySummary::success>, set, true,
        suite.measure == Measure::kSuccess);
    add_pooled(what("pooled success"), paired_success, set);
    add(what("correct"), share<&QuerySummary::correct>, set, true,
        suite.measure == Measure::kCorrect);
    add_pooled(what("pooled correct"), paired_correct, set);
    add(what("false positive"), share<&QuerySummary::false_positive>, set, false, false);
    add(what("distance where both answer", "m"), distance, set, false, true);
  }
  add({"ATE where both track", "m", "", with_labels(labels)}, ate, QuerySet::kHeldOut, false, true);
  return comparisons;
}

}  // namespace

std::vector<CategoryRow> make_category_rows(const Suite& suite, std::span<const Row> rows) {
  std::vector<std::string> groups = categories(suite);
  groups.emplace_back(kAllCategories);
  std::vector<CategoryRow> result;
  for (std::size_t level = 0; level < suite.levels.size(); ++level)
    for (const Labels& labels : suite.labels)
      for (std::size_t p = 0; p < parameter_points(suite).size(); ++p)
        for (std::size_t g = 0; g < groups.size(); ++g)
          for (std::size_t s = 0; s < suite.systems.size(); ++s) {
            const auto is_in = [&](const Environment& e) {
              return fits(e, suite.levels[level]) && fits(e, labels) &&
                     (g + 1 == groups.size() || e.category == groups[g]);
            };
            std::vector<const Row*> scenes = scenes_of(suite, rows, level, labels, p, s);
            std::erase_if(scenes, [&](const Row* row) {
              return row == nullptr || !is_in(suite.environments[row->environment]);
            });
            const auto of =
                static_cast<std::size_t>(std::ranges::count_if(suite.environments, is_in));
            if (!scenes.empty()) result.push_back(together(groups[g], std::move(scenes), of));
          }
  return result;
}

std::vector<SceneFamily> compare_over_scenes(const Suite& suite, std::span<const Row> rows) {
  std::vector<SceneFamily> families;
  for (const SystemPair& systems : suite.compare)
    for (std::size_t level = 0; level < suite.levels.size(); ++level)
      for (std::size_t p = 0; p < parameter_points(suite).size(); ++p) {
        SceneFamily family{level, p, systems, {}};
        for (const Labels& labels : suite.labels)
          for (Comparison& c :
               compare(scenes_of(suite, rows, level, labels, p, systems.first),
                       scenes_of(suite, rows, level, labels, p, systems.second), labels, suite))
            family.comparisons.push_back(std::move(c));
        if (family.comparisons.empty()) continue;
        holm(family.comparisons);
        families.push_back(std::move(family));
      }
  return families;
}

bool enough_for(const Comparison& share, double margin) {
  return margin * static_cast<double>(share.pairs) >= 3.0;
}

bool not_inferior(const Comparison& share, double margin) {
  return share.low > -margin && enough_for(share, margin);
}

}  // namespace mh
