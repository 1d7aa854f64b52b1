// SPDX-License-Identifier: Apache-2.0
#include "bench/report/results_json.hpp"

#include <numbers>

#include <opencv2/core/version.hpp>

#include "bench/protocol/loop_audit.hpp"
#include "bench/report/episodes_report.hpp"
#include "bench/report/graded_report.hpp"
#include "bench/report/suite_json.hpp"
#include "bench/results/scenes.hpp"
#include "bench/suite/json_fields.hpp"
#include "slam/config/slam.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

/// A place's inputs by name, without the files that they were read from: reproduction.json lists
/// those.
Json place_json(const PlaceFacts& place) {
  Json json = json_of(place);
  json["inputs"] = Json::object();
  for (const InputDigest& input : place.inputs) json["inputs"][input.name] = hex(input.digest);
  return json;
}

/// A query as JSON, made from its list of fields. The fields that are reported for the whole run
/// are left out: digests, which are chained, and counts of matches, which are summed.
Json query_json(const QueryScore& query) {
  Json json = Json::object();
  const auto add = [&](const char* name, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (!kIsDigest<Value> && !std::is_same_v<Value, std::optional<MatchCounts>>)
      json[name] = json_of(value);
  };
  fields(query, add);
  if (!is_judged(query)) json["correct"] = json["false_positive"] = nullptr;
  return json;
}

Json digests_json(const RunResult& run) {
  std::uint64_t images = 0, poses = 0;
  const auto add = [&](const auto& shown) {
    images = chained(images, shown.image_digest);
    poses = chained(poses, shown.pose_digest);
  };
  for (const MappedFrame& call : run.mapping.calls) add(call);
  for_each_query(run, [&](const QueryScore& q) { add(q.answer); });
  return {
      {"images", hex(images)}, {"poses", hex(poses)}, {"trajectory", hex(digest(run.estimate))}};
}

/// The settings as JSON; null for an outside program, which has none of ours.
Json settings_json(const RunSpec& spec, Json settings) {
  return spec.system.takes_settings() ? std::move(settings) : Json();
}

Json points_json(const RunResult& run) {
  Json points = Json::array();
  for (std::size_t i = 0; i < run.points.size(); ++i) {
    Json point = {{"settings", settings_json(run.spec, json_of(run.spec.points[i]))}};
    for (const QuerySet set : kQuerySets) {
      Json list = Json::array();
      for (const QueryScore& q : queries(run.points[i], set)) list.push_back(query_json(q));
      point[std::string(name(set))] = std::move(list);
    }
    points.push_back(std::move(point));
  }
  return points;
}

Json loops_json(const LoopAudit& loops) {
  const bool judged = loops.closed == 0 || loops.unknown < loops.closed;
  return {{"closed", loops.closed},
          {"false_positive", judged ? Json(loops.false_positive) : Json()},
          {"worst_m", judged ? Json(loops.worst_m) : Json()},
          {"worst_deg", judged ? Json(loops.worst_rad * 180.0 / std::numbers::pi) : Json()}};
}

Json summary_json(const QuerySummary& summary) {
  if (summary.queries == 0) return nullptr;
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

Json figures_json(std::span<const Figure> figures) {
  Json json = Json::object();
  for (const auto& [metric, value] : figures) {
    Json* place = &json;
    std::size_t from = 0;
    for (auto dot = metric.name.find('.'); dot != std::string::npos;
         from = dot + 1, dot = metric.name.find('.', from))
      place = &(*place)[metric.name.substr(from, dot - from)];
    (*place)[metric.name.substr(from)] = json_of(value);
  }
  return json;
}

Json matches_json(const std::optional<MatchCounts>& matches) {
  if (!matches) return nullptr;
  Json all;
  for (std::size_t m = 0; m < matches->size(); ++m) {
    Json& counts = all[std::string(name(static_cast<Matcher>(m)))];
    const auto add = [&](const char* name, std::int64_t count) { counts[name] = count; };
    fields((*matches)[m], add);
  }
  return all;
}

Json run_json(const RunResult& run) {
  const MappingOutcome& m = run.mapping;
  std::size_t keyframes = 0;
  for (const MappedFrame& call : m.calls) keyframes += call.keyframe_added ? 1 : 0;
  Json json = {{"name", run.spec.name},
               {"status", "done"},
               {"environment", run.spec.environment.name},
               {"system", run.spec.system.name},
               {"labels", name(run.spec.labels)},
               {"level", level_name(run.spec.level)},
               {"trial", run.spec.trial},
               {"seed", run.spec.seed},
               {"place", place_json(run.place)},
               {"digests", digests_json(run)},
               {"mapping",
                {{"settings", settings_json(run.spec, json_of(run.spec.slam))},
                 {"track_calls", m.calls.size()},
                 {"failures", m.failures},
                 {"restarts", m.restarts},
                 {"dropped", m.dropped},
                 {"before_map", m.before_map},
                 {"gave_up", m.gave_up},
                 {"skipped", json_of(m.skipped)},
                 {"keyframes_made", keyframes},
                 {"loops", loops_json(audit_loops(m.loops, run.truth, run.spec.protocol))},
                 {"matchers", matches_json(m.matches)}}},
               {"trajectory", figures_json(figures_of(run.trajectory))},
               {"points", points_json(run)}};
  if (run.spec.episodes) json["episodes"] = json_of(run.episodes);
  return json;
}

Json run_json(const FailedRun& run) {
  return {{"name", run.spec.name},
          {"status", "failed"},
          {"error", run.error},
          {"environment", run.spec.environment.name},
          {"system", run.spec.system.name},
          {"labels", name(run.spec.labels)},
          {"level", level_name(run.spec.level)},
          {"trial", run.spec.trial},
          {"seed", run.spec.seed}};
}

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
