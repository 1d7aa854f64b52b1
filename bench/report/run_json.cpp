// SPDX-License-Identifier: Apache-2.0
#include "bench/report/run_json.hpp"

#include <numbers>

#include "bench/protocol/loop_audit.hpp"
#include "bench/report/figures_json.hpp"
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

/// A query by its list of fields, except those that are reported for the whole run: digests,
/// chained, and counts of matches, summed.
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

/// Settings that an outside program does not have.
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

}  // namespace

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

}  // namespace mh
