// SPDX-License-Identifier: Apache-2.0
#include "bench/report/json.hpp"

#include <opencv2/core/version.hpp>

#include "bench/report/episodes_report.hpp"
#include "bench/report/figures_json.hpp"
#include "bench/report/graded_report.hpp"
#include "bench/report/run_json.hpp"
#include "bench/report/suite_json.hpp"
#include "bench/results/scenes.hpp"
#include "bench/suite/json_fields.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

Json summary_json(const QuerySummary& summary) {
  if (summary.queries == 0) return nullptr;  // no queries
  return figures_json(figures_of(summary));
}

Json row_json(const Row& row, const Suite& suite) {
  const auto known = [&](const Json& value) { return row.trials.empty() ? Json() : value; };
  return {{"environment", suite.environments[row.environment].name},
          {"category", suite.environments[row.environment].category},
          {"level", level_name(suite.levels[row.level])},
          {"labels", name(row.labels)},
          {"parameters", row.parameters},
          {"system", suite.systems[row.system].name},
          {"trials", row.trials.size()},
          {"failed", row.failed},
          {"trajectory", known(figures_json(figures_of(row.trajectory)))},
          {"mapping", known(figures_json(figures_of(row.mapping)))},
          {"held_out", summary_json(row.held_out)},
          {"second_tour", summary_json(row.second_tour)},
          {"graded", summary_json(row.graded)},
          {"matchers", matches_json(row.matches)}};
}

Json category_json(const CategoryRow& row, const Suite& suite) {
  return {{"category", row.category},
          {"level", level_name(suite.levels[row.level])},
          {"labels", name(row.labels)},
          {"parameters", row.parameters},
          {"system", suite.systems[row.system].name},
          {"scenes", row.scenes},
          {"of_scenes", row.of},
          {"failed", row.failed},
          {"trajectory", row.scenes > 0 ? figures_json(figures_of(row.trajectory)) : Json()},
          {"held_out", summary_json(row.held_out)},
          {"second_tour", summary_json(row.second_tour)},
          {"graded", summary_json(row.graded)}};
}

Json comparison_json(const Suite& suite, const SystemPair& systems, const Comparison& c) {
  const std::string& first = suite.systems[systems.first].name;
  const std::string& second = suite.systems[systems.second].name;
  const Verdict v = verdict(c);
  const auto known = [&](double value) { return c.pairs > 0 ? json_of(value) : Json(); };
  return {{"what", c.what.text()},
          {"first", first},
          {"second", second},
          {"pairs", c.pairs},
          {"clusters", c.clusters > 0 ? Json(c.clusters) : Json()},
          {"in_family", c.in_family},
          {"difference", known(c.difference)},
          {"low", known(c.low)},
          {"high", known(c.high)},
          {"p", known(c.p)},
          {"p_holm", counts(c) ? Json(c.p_holm) : Json()},
          {"detectable", known(c.detectable)},
          {"better", v == Verdict::kUndecided     ? Json()
                     : v == Verdict::kFirstBetter ? Json(first)
                                                  : Json(second)}};
}

}  // namespace

Json results_json(const Suite& suite, std::span<const RunResult> runs,
                  std::span<const FailedRun> failed, std::span<const std::string> missing) {
  const std::vector<Row> rows = make_rows(suite, runs, failed);
  Json run_list = Json::array(), row_list = Json::array(), comparisons = Json::array();
  for (const RunResult& run : runs) run_list.push_back(run_json(run));
  for (const FailedRun& run : failed) run_list.push_back(run_json(run));
  for (const Row& row : rows) row_list.push_back(row_json(row, suite));
  for (const Family& family : compare_systems(suite, rows))
    for (const Comparison& c : family.comparisons) {
      Json json = comparison_json(suite, family.systems, c);
      json["environment"] = suite.environments[family.environment].name;
      json["level"] = level_name(suite.levels[family.level]);
      comparisons.push_back(std::move(json));
    }
  Json categories = Json::array(), over_scenes = Json::array();
  if (suite.environments.size() > 1) {
    for (const CategoryRow& row : make_category_rows(suite, rows))
      categories.push_back(category_json(row, suite));
    for (const SceneFamily& family : compare_over_scenes(suite, rows))
      for (const Comparison& c : family.comparisons) {
        Json json = comparison_json(suite, family.systems, c);
        json["level"] = level_name(suite.levels[family.level]);
        json["parameters"] = family.parameters;
        if (suite.non_inferiority_margin && c.what.measure == name(suite.measure))
          json["not_inferior"] = not_inferior(c, *suite.non_inferiority_margin);
        over_scenes.push_back(std::move(json));
      }
  }
  Json json = {
      {"format", kResultsFormat},
      {"versions", {{"modelhouse", MH_VERSION}, {"compiler", __VERSION__}, {"opencv", CV_VERSION}}},
      {"suite", suite_json(suite)},
      {"rows", row_list},
      {"comparisons", comparisons},
      {"categories", categories},
      {"graded", graded_json(suite, rows)},
      {"comparisons_over_scenes", over_scenes},
      {"runs", run_list},
      {"missing", missing}};
  if (suite.episodes) json["episodes"] = episodes_json(suite, runs);
  return json;
}

}  // namespace mh
