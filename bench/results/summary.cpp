// SPDX-License-Identifier: Apache-2.0
#include "bench/results/summary.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "bench/results/trajectory_score.hpp"

namespace mh {
namespace {

template <class Get>
double median_over(const std::vector<const RunResult*>& trials, Get get) {
  std::vector<double> values;
  for (const RunResult* run : trials) values.push_back(static_cast<double>(get(*run)));
  return median(std::move(values));
}

QuerySummary median_summary(const std::vector<const RunResult*>& trials, QuerySet set) {
  std::vector<QuerySummary> all;
  for (const RunResult* run : trials) all.push_back(summarize(queries(*run, set)));
  QuerySummary m;
  for (double QuerySummary::*field :
       {&QuerySummary::queries, &QuerySummary::success, &QuerySummary::correct,
        &QuerySummary::wrong, &QuerySummary::attempts, &QuerySummary::keyframes, &QuerySummary::c1,
        &QuerySummary::c2, &QuerySummary::c3, &QuerySummary::final, &QuerySummary::single_candidate,
        &QuerySummary::label_mass}) {
    std::vector<double> values;
    for (const QuerySummary& s : all) values.push_back(s.*field);
    m.*field = median(std::move(values));
  }
  for (std::optional<double> QuerySummary::*field :
       {&QuerySummary::distance_mean_m, &QuerySummary::distance_median_m,
        &QuerySummary::aligned_distance_mean_m}) {
    std::vector<std::optional<double>> values;
    for (const QuerySummary& s : all) values.push_back(s.*field);
    m.*field = median_of_known(values);
  }
  return m;
}

void add(MatchCounts& sum, const MatchCounts& counts) {
  for (std::size_t m = 0; m < sum.size(); ++m) sum[m] += counts[m];
}

Row make_row(SystemKind system, LabelMode labels, std::size_t level,
             std::vector<const RunResult*> trials) {
  Row row;
  row.system = system;
  row.labels = labels;
  row.level = level;
  row.trials = std::move(trials);
  row.trajectory.completeness =
      median_over(row.trials, [](const RunResult& run) { return run.trajectory.completeness; });
  for (std::optional<double> TrajectoryScore::*field :
       {&TrajectoryScore::ate_rmse_m, &TrajectoryScore::ate_first_pose_m,
        &TrajectoryScore::rpe_frame_rmse_m, &TrajectoryScore::rpe_second_rmse_m}) {
    std::vector<std::optional<double>> values;
    for (const RunResult* run : row.trials) values.push_back(run->trajectory.*field);
    row.trajectory.*field = median_of_known(values);
  }
  row.restarts = median_over(row.trials, [](const RunResult& r) { return r.mapping.restarts; });
  row.dropped =
      median_over(row.trials, [](const RunResult& r) { return r.mapping.dropped.size(); });
  row.held_out = median_summary(row.trials, QuerySet::kHeldOut);
  row.second_tour = median_summary(row.trials, QuerySet::kSecondTour);

  std::vector<double> track_ms, relocalize_ms;
  for (const RunResult* run : row.trials) {
    add(row.matches, run->mapping.matches);
    for (const auto* set : {&run->held_out, &run->second_tour})
      for (const QueryScore& q : *set) add(row.matches, q.answer.matches);
    const CallTimes& times = run->times;
    track_ms.insert(track_ms.end(), times.track_ms.begin(), times.track_ms.end());
    relocalize_ms.insert(relocalize_ms.end(), times.relocalize_ms.begin(),
                         times.relocalize_ms.end());
  }
  row.track = summarize(std::move(track_ms));
  row.relocalize = summarize(std::move(relocalize_ms));
  return row;
}

/// Per query, the median over trials of a value; absent where no trial has one.
template <class Get>
std::vector<PairedDifference> per_query(const Row& row, QuerySet set, Get get) {
  std::map<std::size_t, std::vector<double>> values;
  for (const RunResult* run : row.trials)
    for (const QueryScore& q : queries(*run, set)) {
      auto& of_query = values[q.answer.index];
      if (const std::optional<double> value = get(q)) of_query.push_back(*value);
    }
  std::vector<PairedDifference> result;
  for (auto& [index, v] : values) {
    const bool present = !v.empty();
    result.push_back({median(std::move(v)), present});
  }
  return result;
}

template <class Get>
std::vector<PairedDifference> differences(const Row& first, const Row& second, QuerySet set,
                                          Get get) {
  std::vector<PairedDifference> result = per_query(first, set, get);
  const std::vector<PairedDifference> other = per_query(second, set, get);
  for (std::size_t i = 0; i < result.size() && i < other.size(); ++i) {
    result[i].difference -= other[i].difference;
    result[i].present = result[i].present && other[i].present;
  }
  return result;
}

const Row* find_row(std::span<const Row> rows, std::size_t level, LabelMode labels,
                    SystemKind system) {
  for (const Row& row : rows)
    if (row.level == level && row.labels == labels && row.system == system) return &row;
  return nullptr;
}

std::vector<Comparison> compare_rows(const Row& semantic, const Row& plain, std::uint64_t seed) {
  std::vector<Comparison> comparisons;
  for (const QuerySet set : {QuerySet::kHeldOut, QuerySet::kSecondTour}) {
    if (queries(*semantic.trials.front(), set).empty()) continue;
    const auto label = [&](const char* what) {
      return fmt::format("{}, {}, {} labels", what, name(set), name(semantic.labels));
    };
    const auto success = [](const QueryScore& q) { return std::optional(q.success ? 1.0 : 0.0); };
    const auto correct = [](const QueryScore& q) { return std::optional(q.correct ? 1.0 : 0.0); };
    const auto distance = [](const QueryScore& q) {
      return q.success ? std::optional(q.distance_m) : std::nullopt;
    };
    comparisons.push_back(
        compare_paired(label("success"), differences(semantic, plain, set, success), true, seed));
    comparisons.push_back(
        compare_paired(label("correct"), differences(semantic, plain, set, correct), true, seed));
    comparisons.push_back(compare_paired(label("distance where both answer, m"),
                                         differences(semantic, plain, set, distance), false, seed));
    comparisons.back().more_is_better = false;
  }
  return comparisons;
}

}  // namespace

std::string_view name(QuerySet set) {
  return set == QuerySet::kHeldOut ? "held_out" : "second_tour";
}

const std::vector<QueryScore>& queries(const RunResult& run, QuerySet set) {
  return set == QuerySet::kHeldOut ? run.held_out : run.second_tour;
}

QuerySummary summarize(std::span<const QueryScore> queries) {
  QuerySummary s;
  if (queries.empty()) return s;
  std::vector<double> distances, aligned;
  double with_candidates = 0;
  for (const QueryScore& q : queries) {
    s.success += q.success;
    s.correct += q.correct;
    s.wrong += q.wrong;
    s.attempts += q.answer.attempts;
    if (q.success) {
      distances.push_back(q.distance_m);
      aligned.push_back(q.aligned_distance_m);
    }
    if (const auto& c = q.answer.candidates) {
      ++with_candidates;
      s.keyframes += c->keyframes;
      s.c1 += c->c1;
      s.c2 += c->c2;
      s.c3 += c->c3;
      s.final += c->final;
      s.single_candidate += c->final == 1;
      s.label_mass += c->label_mass;
    }
  }
  s.queries = static_cast<double>(queries.size());
  for (double* share : {&s.success, &s.correct, &s.wrong, &s.attempts}) *share /= s.queries;
  if (with_candidates > 0)
    for (double* m :
         {&s.keyframes, &s.c1, &s.c2, &s.c3, &s.final, &s.single_candidate, &s.label_mass})
      *m /= with_candidates;
  if (distances.empty()) return s;
  s.distance_mean_m = mean(distances);
  s.aligned_distance_mean_m = mean(aligned);
  s.distance_median_m = median(std::move(distances));
  return s;
}

std::vector<Row> make_rows(const Suite& suite, std::span<const RunResult> runs) {
  std::vector<Row> rows;
  for (std::size_t level = 0; level < suite.levels.size(); ++level)
    for (const LabelMode labels : suite.labels)
      for (const SystemKind system : suite.systems) {
        std::vector<const RunResult*> trials;
        for (const RunResult& run : runs)
          if (run.spec.level == level && run.spec.system == system &&
              (system == SystemKind::kPlain || run.spec.labels == labels))
            trials.push_back(&run);
        if (!trials.empty()) rows.push_back(make_row(system, labels, level, std::move(trials)));
      }
  return rows;
}

std::vector<std::vector<Comparison>> compare_systems(const Suite& suite,
                                                     std::span<const Row> rows) {
  std::vector<std::vector<Comparison>> by_level;
  for (std::size_t level = 0; level < suite.levels.size(); ++level) {
    std::vector<Comparison> family;
    for (const LabelMode labels : suite.labels) {
      const Row* semantic = find_row(rows, level, labels, SystemKind::kSemantic);
      const Row* plain = find_row(rows, level, labels, SystemKind::kPlain);
      if (semantic == nullptr || plain == nullptr) continue;
      for (Comparison& c : compare_rows(*semantic, *plain, suite.seed))
        family.push_back(std::move(c));
    }
    holm(family);
    by_level.push_back(std::move(family));
  }
  return by_level;
}

std::array<std::optional<double>, 2> ate_over_common_frames(const Row& first, const Row& second,
                                                            const Trajectory& truth) {
  std::vector<std::optional<double>> a, b;
  const std::size_t trials = std::min(first.trials.size(), second.trials.size());
  for (std::size_t t = 0; t < trials; ++t) {
    const Trajectory& x = first.trials[t]->estimate;
    const Trajectory& y = second.trials[t]->estimate;
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
