// SPDX-License-Identifier: Apache-2.0
#include "bench/results/rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "bench/protocol/metrics/metrics_by_name.hpp"
#include "slam/config/slam.hpp"

namespace mh {
namespace {

/// The median of a score over a row's trials, field by field.
template <class GetScore>
auto median_score(const std::vector<Trial>& trials, GetScore get) {
  std::vector<decltype(get(trials.front()))> scores;
  for (const Trial& trial : trials) scores.push_back(get(trial));
  return reduce(std::span(std::as_const(scores)), median_of_known);
}

QuerySummary median_summary(const std::vector<Trial>& trials, QuerySet set) {
  return median_score(trials, [&](const Trial& t) { return summarize(queries(*t.point, set)); });
}

/// Fills in everything that is computed from the trials.
Row fill_in(Row row) {
  row.trajectory = median_score(row.trials, [](const Trial& t) { return t.run->trajectory; });
  row.mapping = median_score(row.trials, [](const Trial& t) { return count(t.run->mapping); });
  for (const QuerySet set : kQuerySets) of_query_set(row, set) = median_summary(row.trials, set);

  std::vector<double> track_ms, relocalize_ms;
  for (const Trial& trial : row.trials) {
    add(trial.run->mapping.matches, row.matches);
    for (const QuerySet set : kQuerySets)
      for (const QueryScore& q : queries(*trial.point, set)) add(q.answer.matches, row.matches);
    const CallTimes& times = trial.run->times;
    track_ms.insert(track_ms.end(), times.track_ms.begin(), times.track_ms.end());
    relocalize_ms.insert(relocalize_ms.end(), times.relocalize_ms.begin(),
                         times.relocalize_ms.end());
  }
  row.track = summarize(std::move(track_ms));
  row.relocalize = summarize(std::move(relocalize_ms));
  return row;
}

/// For each query frame, the median of a value over the trials; absent if no trial has the value.
template <class Get>
std::map<std::size_t, std::optional<double>> per_query(const Row& row, QuerySet set, Get get) {
  std::map<std::size_t, std::vector<std::optional<double>>> values;
  for (const Trial& trial : row.trials)
    for (const QueryScore& q : queries(*trial.point, set)) values[q.answer.index].push_back(get(q));
  std::map<std::size_t, std::optional<double>> medians;
  for (const auto& [index, of_trials] : values) medians[index] = median_of_known(of_trials);
  return medians;
}

/// Differences over the queries that both systems were given: for a system that needs labels, some
/// queries may have been skipped.
template <class Get>
std::vector<PairedDifference> differences(const Row& first, const Row& second, QuerySet set,
                                          Get get) {
  const std::map<std::size_t, std::optional<double>> other = per_query(second, set, get);
  std::vector<PairedDifference> result;
  for (const auto& [index, value] : per_query(first, set, get))
    if (const auto same = other.find(index); same != other.end())
      result.push_back(paired_difference(value, same->second));
  return result;
}

std::optional<double> answered(const QueryScore& q) {
  return q.success ? 1.0 : 0.0;
}

std::optional<double> judged_correct(const QueryScore& q) {
  return is_judged(q) ? std::optional(q.correct ? 1.0 : 0.0) : std::nullopt;
}

}  // namespace

std::vector<PairedDifference> paired_success(const Row& first, const Row& second, QuerySet set) {
  return differences(first, second, set, answered);
}

std::vector<PairedDifference> paired_correct(const Row& first, const Row& second, QuerySet set) {
  return differences(first, second, set, judged_correct);
}

namespace {

std::vector<Comparison> compare_rows(const Row& first, const Row& second, const Suite& suite) {
  const std::uint64_t seed = suite.seed;
  std::vector<Comparison> comparisons;
  for (const QuerySet set : kQuerySets) {
    if (summary(first, set).queries == 0) continue;
    const auto add = [&](const char* measure, const char* unit, Comparison c) -> Comparison& {
      c.what = {measure, unit, std::string(name(set)), with_labels(first.labels)};
      return comparisons.emplace_back(std::move(c));
    };
    add("success", "", compare_paired(paired_success(first, second, set), true, seed)).in_family =
        suite.measure == Measure::kSuccess;
    add("correct", "", compare_correct(first, second, set, seed)).in_family =
        suite.measure == Measure::kCorrect;
    add("distance where both answer", "m", compare_distances(first, second, set, seed))
        .more_is_better = false;
  }
  return comparisons;
}

/// Whether a run has the row's environment, level, system and labels.
bool belongs(const RunSpec& spec, const Suite& suite, const Row& row) {
  const SystemSpec& system = suite.systems[row.system];
  return spec.environment.name == suite.environments[row.environment].name &&
         spec.level == suite.levels[row.level] && spec.system.name == system.name &&
         (!system.sees_labels() || name(spec.labels) == name(row.labels));
}

/// Index of the parameter point of a run whose queries were answered with these settings.
std::optional<std::size_t> find_point(const RunSpec& spec, const SlamConfig& settings) {
  SlamConfig at_point = spec.slam;
  at_point.semantics = settings.semantics;
  if (at_point != settings) return std::nullopt;
  const auto point = std::ranges::find(spec.points, settings.semantics);
  if (point == spec.points.end()) return std::nullopt;
  return static_cast<std::size_t>(point - spec.points.begin());
}

}  // namespace

std::vector<Row> make_rows(const Suite& suite, std::span<const RunResult> runs,
                           std::span<const FailedRun> failed) {
  const std::vector<SharedSlamConfig> points = parameter_points(suite);
  std::vector<Row> rows;
  for (std::size_t e = 0; e < suite.environments.size(); ++e)
    for (std::size_t level = 0; level < suite.levels.size(); ++level)
      for (const Labels& labels : suite.labels)
        for (std::size_t p = 0; p < points.size(); ++p)
          for (std::size_t s = 0; s < suite.systems.size(); ++s) {
            Row row;
            row.environment = e;
            row.level = level;
            row.system = s;
            row.labels = labels;
            row.parameters = p;
            if (!fits(suite.environments[e], labels)) continue;
            const SlamConfig seen = settings_of(suite.systems[s], points[p]);
            for (const RunResult& run : runs)
              if (belongs(run.spec, suite, row))
                if (const auto point = find_point(run.spec, seen);
                    point && *point < run.points.size())
                  row.trials.push_back({&run, &run.points[*point]});
            for (const FailedRun& run : failed)
              if (belongs(run.spec, suite, row) && find_point(run.spec, seen)) ++row.failed;
            if (!row.trials.empty())
              rows.push_back(fill_in(std::move(row)));
            else if (row.failed > 0)
              rows.push_back(std::move(row));
          }
  return rows;
}

std::vector<Family> compare_systems(const Suite& suite, std::span<const Row> rows) {
  std::vector<Family> families;
  for (const SystemPair& systems : suite.compare)
    for (const Row& first : rows) {
      if (first.system != systems.first || first.parameters != 0 || first.trials.empty()) continue;
      const auto second = std::find_if(rows.begin(), rows.end(), [&](const Row& row) {
        return row.system == systems.second && !row.trials.empty() &&
               row.environment == first.environment && row.level == first.level &&
               row.labels == first.labels && row.parameters == first.parameters;
      });
      if (second == rows.end()) continue;
      if (families.empty() || families.back().environment != first.environment ||
          families.back().level != first.level || families.back().systems != systems)
        families.push_back({first.environment, first.level, systems, {}});
      for (Comparison& c : compare_rows(first, *second, suite))
        families.back().comparisons.push_back(std::move(c));
    }
  for (Family& family : families) holm(family.comparisons);
  return families;
}

Comparison compare_distances(const Row& first, const Row& second, QuerySet set,
                             std::uint64_t seed) {
  const auto distance = [](const QueryScore& q) { return q.distance_m; };
  return compare_paired(differences(first, second, set, distance), false, seed);
}

std::size_t shared_queries(const Row& first, const Row& second, QuerySet set) {
  return static_cast<std::size_t>(
      std::lround(std::min(summary(first, set).queries, summary(second, set).queries)));
}

Comparison compare_correct(const Row& first, const Row& second, QuerySet set, std::uint64_t seed) {
  return compare_paired(paired_correct(first, second, set), true, seed);
}

std::array<std::optional<double>, 2> ate_over_common_frames(const Row& first, const Row& second) {
  std::vector<std::optional<double>> a, b;
  for (const Trial& trial : first.trials) {
    const auto other = std::ranges::find_if(
        second.trials, [&](const Trial& t) { return t.run->spec.trial == trial.run->spec.trial; });
    if (other == second.trials.end()) continue;  // this trial of the second system failed
    const Trajectory& truth = trial.run->truth;
    const Trajectory& x = trial.run->estimate;
    const Trajectory& y = other->run->estimate;
    Trajectory common_x, common_y;
    for (std::size_t i = 0, j = 0; i < x.size() && j < y.size();) {
      if (x[i].stamp_ns == y[j].stamp_ns) {
        common_x.push_back(x[i++]);
        common_y.push_back(y[j++]);
      } else {
        x[i].stamp_ns < y[j].stamp_ns ? ++i : ++j;
      }
    }
    a.push_back(score_trajectory(common_x, truth, common_x.size()).ate_rmse_m);
    b.push_back(score_trajectory(common_y, truth, common_y.size()).ate_rmse_m);
  }
  return {median_of_known(a), median_of_known(b)};
}

}  // namespace mh
