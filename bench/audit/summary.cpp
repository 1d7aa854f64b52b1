// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/summary.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "bench/suite/labels.hpp"
#include "slam/config/slam.hpp"

namespace mh {
namespace {

using Queries = std::span<const QueryAudit* const>;

template <class Holds>
std::size_t count(Queries queries, Holds holds) {
  return static_cast<std::size_t>(
      std::ranges::count_if(queries, [&](const QueryAudit* q) { return holds(*q); }));
}

std::optional<double> ratio(std::size_t part, std::size_t all) {
  if (all == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(all);
}

template <class Value>
std::vector<double> known(Queries queries, Value value) {
  std::vector<double> values;
  for (const QueryAudit* q : queries)
    if (const std::optional<double> v = value(*q)) values.push_back(*v);
  return values;
}

template <class Value>
std::optional<double> mean(Queries queries, Value value) {
  const std::vector<double> values = known(queries, value);
  if (values.empty()) return std::nullopt;
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

template <class Value>
std::optional<double> median(Queries queries, Value value) {
  std::vector<double> values = known(queries, value);
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

void summarize_retrieval(Queries queries, AuditSummary& s) {
  std::size_t candidates = 0, relevant = 0;
  for (const QueryAudit* q : queries) {
    candidates += static_cast<std::size_t>(q->candidates);
    relevant += static_cast<std::size_t>(q->relevant_candidates);
  }
  s.candidates = ratio(candidates, queries.size()).value_or(0);
  s.relevant_candidates = ratio(relevant, candidates);
  const std::size_t solvable = count(queries, [](const QueryAudit& q) { return q.by_any; });
  const auto of_solvable = [&](auto holds) { return ratio(count(queries, holds), solvable); };
  s.first_correct_of_solvable = of_solvable([](const QueryAudit& q) { return q.first_correct; });
  s.candidate_solves = of_solvable([](const QueryAudit& q) { return q.solving_candidate > 0; });
  s.first_candidate_solves =
      of_solvable([](const QueryAudit& q) { return q.solving_candidate == 1; });
  s.most_similar_solves = of_solvable([](const QueryAudit& q) { return q.solving_rank == 1; });
  s.average_precision = mean(queries, [](const QueryAudit& q) { return q.average_precision; });
  s.precision_1 = mean(queries, [](const QueryAudit& q) { return q.precision_1; });
  s.precision_5 = mean(queries, [](const QueryAudit& q) { return q.precision_5; });
  s.precision_10 = mean(queries, [](const QueryAudit& q) { return q.precision_10; });
  s.recall_1 = mean(queries, [](const QueryAudit& q) { return q.recall_1; });
  s.recall_5 = mean(queries, [](const QueryAudit& q) { return q.recall_5; });
  s.recall_10 = mean(queries, [](const QueryAudit& q) { return q.recall_10; });
  s.solving_rank = median(queries, [](const QueryAudit& q) {
    return q.solving_rank ? std::optional<double>(*q.solving_rank) : std::nullopt;
  });
  s.solving_m = median(queries, [](const QueryAudit& q) { return q.solving_m; });
  s.solving_deg = median(queries, [](const QueryAudit& q) { return q.solving_deg; });
}

}  // namespace

AuditSummary summarize(Queries queries) {
  AuditSummary s;
  s.queries = queries.size();
  if (queries.empty()) return s;
  const auto share = [&](auto holds) { return *ratio(count(queries, holds), queries.size()); };
  const auto cause = [&](FirstCause c) {
    return share([&](const QueryAudit& q) { return q.cause == c; });
  };
  s.correct = share([](const QueryAudit& q) { return q.correct; });
  s.first_correct = share([](const QueryAudit& q) { return q.first_correct; });
  s.wrong_candidates = cause(FirstCause::kWrongCandidates);
  s.nothing_in_sight = cause(FirstCause::kNothingInSight);
  s.few_matches = cause(FirstCause::kFewMatches);
  s.false_answer = cause(FirstCause::kFalseAnswer);
  s.few_inliers = cause(FirstCause::kFewInliers);
  s.by_any = share([](const QueryAudit& q) { return q.by_any; });
  s.by_nearest = share([](const QueryAudit& q) { return q.by_nearest; });
  s.without_false = share([](const QueryAudit& q) { return q.without_false; });
  s.with_true_pose = share([](const QueryAudit& q) { return q.with_true_pose; });
  summarize_retrieval(queries, s);
  const auto mean_of = [&](auto value) {
    return *mean(queries, [&](const QueryAudit& q) { return std::optional<double>(value(q)); });
  };
  s.best_co_visible = mean_of([](const QueryAudit& q) { return q.best_co_visible; });
  s.label_mass = mean_of([](const QueryAudit& q) { return q.label_mass; });
  for (const QueryAudit* q : queries) add(q->matches, s.matches);
  return s;
}

std::vector<AuditRow> audit_rows(const Suite& suite, std::span<const AuditedRun> runs,
                                 bool by_environment) {
  std::vector<AuditRow> rows;
  std::vector<std::vector<const QueryAudit*>> of_row;
  using Key = std::tuple<std::string, std::string, std::string, std::string, std::string, QuerySet>;
  std::map<Key, std::size_t> known_rows;
  for (const AuditedRun& run : runs)
    for (std::size_t p = 0; p < run.audit.points.size(); ++p) {
      SlamConfig settings = *run.spec.slam;
      settings.semantics = run.spec.points[p];
      for (const QuerySet set : kQuerySets) {
        const std::vector<QueryAudit>& audited = queries(run.audit.points[p], set);
        if (audited.empty()) continue;
        AuditRow row{.level = level_name(run.spec.level),
                     .system = run.spec.system.name,
                     .labels = name(run.spec.labels),
                     .settings = shown_point(suite.sweep, settings),
                     .environment = by_environment ? run.spec.environment.name : std::string(),
                     .set = set,
                     .summary = {}};
        const auto [place, is_new] = known_rows.try_emplace(
            {row.level, row.system, row.labels, row.settings, row.environment, set}, rows.size());
        if (is_new) {
          rows.push_back(std::move(row));
          of_row.emplace_back();
        }
        for (const QueryAudit& q : audited) of_row[place->second].push_back(&q);
      }
    }
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r].summary = summarize(of_row[r]);
  return rows;
}

}  // namespace mh
