// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/query_means.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "bench/protocol/metrics/averages.hpp"
#include "bench/protocol/metrics/metrics_by_name.hpp"

namespace mh {
namespace {

/// Mean of a number over the queries for which the system reports it; absent if it never does.
template <class Get>
std::optional<double> mean_reported(std::span<const QueryScore> queries, Get get) {
  double sum = 0, count = 0;
  for (const QueryScore& q : queries)
    if (const std::optional<double> value = get(q.answer.candidates)) {
      sum += *value;
      ++count;
    }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

}  // namespace

QuerySummary summarize(std::span<const QueryScore> queries) {
  QuerySummary s;
  if (queries.empty()) return s;
  std::vector<double> distances, aligned;
  double correct = 0, false_positive = 0;
  for (const QueryScore& q : queries) {
    s.success += q.success;
    correct += q.correct;
    false_positive += q.false_positive;
    s.attempts += q.answer.attempts;
    if (q.distance_m) distances.push_back(*q.distance_m);
    if (q.aligned_distance_m) aligned.push_back(*q.aligned_distance_m);
  }
  s.queries = static_cast<double>(queries.size());
  double placed = 0, in_map = 0, found_there = 0;
  for (const QueryScore& q : queries) {
    if (!q.in_map) continue;
    ++placed;
    in_map += *q.in_map;
    found_there += *q.in_map && q.success;
  }
  if (placed > 0) s.in_map = in_map / placed;
  if (in_map > 0) s.success_in_map = found_there / in_map;
  for (double* share : {&s.success, &s.attempts}) *share /= s.queries;
  if (std::ranges::any_of(queries, is_judged)) {
    s.correct = correct / s.queries;
    s.false_positive = false_positive / s.queries;
  }
  for (const auto& [field, count] : {std::pair(&QuerySummary::keyframes, &Candidates::keyframes),
                                     {&QuerySummary::c1, &Candidates::c1},
                                     {&QuerySummary::c2, &Candidates::c2},
                                     {&QuerySummary::c3, &Candidates::c3},
                                     {&QuerySummary::final, &Candidates::final}})
    s.*field = mean_reported(queries, [count = count](const Candidates& c) { return c.*count; });
  s.single_candidate = mean_reported(queries, [](const Candidates& c) {
    return c.final ? std::optional<double>(*c.final == 1) : std::nullopt;
  });
  for (const auto& [field, reported] :
       {std::pair(&QuerySummary::label_mass, &Candidates::label_mass),
        {&QuerySummary::gamma, &Candidates::gamma},
        {&QuerySummary::unscored, &Candidates::unscored},
        {&QuerySummary::stale, &Candidates::stale},
        {&QuerySummary::stale_weight, &Candidates::stale_weight},
        {&QuerySummary::stale_age, &Candidates::stale_age}})
    s.*field =
        mean_reported(queries, [reported = reported](const Candidates& c) { return c.*reported; });
  if (distances.empty()) return s;
  s.distance_mean_m = mean(distances);
  s.aligned_distance_mean_m = mean(aligned);
  s.distance_median_m = median(std::move(distances));
  return s;
}

EpisodeSummary summarize(std::span<const EpisodeScore> episodes) {
  EpisodeSummary s;
  if (episodes.empty()) return s;
  std::vector<double> times_s;
  for (const EpisodeScore& e : episodes) {
    s.success += e.success;
    s.located += e.located_s.has_value();
    s.spl += e.spl;
    s.collided += e.collisions > 0;
    s.wrong_arrivals += e.wrong_arrival;
    s.worst_contact_m_per_s = std::max(s.worst_contact_m_per_s, e.worst_contact_m_per_s);
    if (e.success) times_s.push_back(e.time_s);
  }
  s.count = static_cast<double>(episodes.size());
  for (double* mean : {&s.success, &s.located, &s.spl, &s.collided, &s.wrong_arrivals})
    *mean /= s.count;
  if (!times_s.empty()) s.median_s = median(std::move(times_s));
  return s;
}

MappingCounts count(const MappingOutcome& mapping) {
  MappingCounts counts;
  counts.failures = mapping.failures;
  counts.restarts = mapping.restarts;
  counts.dropped = static_cast<double>(mapping.dropped.size());
  if (!mapping.matches) return counts;
  const MatcherCounts& c = at(*mapping.matches, Matcher::kLocalMap);
  if (c.compared > 0)
    counts.penalized = static_cast<double>(c.penalized) / static_cast<double>(c.compared);
  return counts;
}

std::vector<Figure> figures_of(const RunResult& run, std::size_t point) {
  std::vector<Figure> figures = figures_of(run.trajectory);
  std::ranges::move(figures_of(count(run.mapping)), std::back_inserter(figures));
  for (const QuerySet set : kQuerySets) {
    const QuerySummary summary = summarize(queries(run.points[point], set));
    if (summary.queries == 0) continue;
    for (Figure& figure : figures_of(summary))
      figures.push_back({under(name(set), std::move(figure.metric)), figure.value});
  }
  if (!run.episodes.empty())
    for (Figure& figure : figures_of(summarize(run.episodes)))
      figures.push_back({under("episodes", std::move(figure.metric)), figure.value});
  return figures;
}

}  // namespace mh
