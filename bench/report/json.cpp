// SPDX-License-Identifier: Apache-2.0
#include "bench/report/json.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <opencv2/core/version.hpp>

#include "bench/plan/outside_program.hpp"
#include "bench/plan/shipped.hpp"
#include "bench/plan/spec_json.hpp"
#include "bench/protocol/loop_audit.hpp"
#include "bench/provenance/code_version.hpp"
#include "bench/provenance/digest.hpp"
#include "bench/provenance/fingerprint.hpp"
#include "bench/results/scenes.hpp"
#include "scenes/recorded/open_sequence.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json pose_json(const SE3& pose) {
  const Eigen::Vector3d& t = pose.translation();
  const Eigen::Quaterniond q = pose.quaternion();
  return Json::array({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

/// A path relative to the suite's folder, however the suite itself was named; what another
/// folder's suite takes of what is shipped, relative to that.
std::string from_suite(const Suite& suite, const std::filesystem::path& file) {
  const auto here = std::filesystem::current_path();
  const auto folder = (here / suite.file).parent_path().lexically_normal();
  const auto is_outside = [](const std::filesystem::path& relative) {
    return relative.empty() || *relative.begin() == "..";
  };
  const std::filesystem::path shipped = file.lexically_relative(data_folder());
  if (!is_outside(shipped) && is_outside(folder.lexically_relative(data_folder())))
    return shipped.generic_string();
  return (here / file).lexically_normal().lexically_relative(folder).generic_string();
}

Json source_json(const Suite& suite, const std::filesystem::path& source) {
  return is_generated(source) ? source.string() : from_suite(suite, source);
}

Json recorded_json(const Suite& suite, const Environment& e) {
  const auto name_of = [&](const std::string& sequence) {
    const auto [layout, path] = split_sequence(sequence);
    return join_sequence(layout, from_suite(suite, path));
  };
  return {{"name", e.name},
          {"category", e.category},
          {"sequence", name_of(e.sequence)},
          {"queries", e.queries ? Json(name_of(*e.queries)) : Json()},
          {"settings", e.settings ? Json(from_suite(suite, *e.settings)) : Json()},
          {"classes", e.classes ? Json(from_suite(suite, *e.classes)) : Json()}};
}

Json environment_json(const Suite& suite, const Environment& e) {
  if (e.is_recorded()) return recorded_json(suite, e);
  return {{"name", e.name},
          {"category", e.category},
          {"scene", source_json(suite, e.scene)},
          {"robot", from_suite(suite, e.robot)},
          {"mapping_tour", source_json(suite, e.mapping_tour)},
          {"query_tour", e.query_tour ? source_json(suite, *e.query_tour) : Json()}};
}

Json system_json(const SystemSpec& system) {
  if (!system.is_program()) return system.name;
  return {{"name", system.name},
          {"command", system.outside.command},
          {"protocol", name(system.outside.mode)},
          {"inputs", system.outside.inputs}};
}

Json sweep_json(const Sweep& sweep) {
  if (sweep.points.empty()) return nullptr;
  Json points = Json::array();
  for (const SlamConfig& point : sweep.points) {
    Json values;
    const Json settings = to_json(point);
    for (const std::string& name : sweep.varied) {
      const std::size_t dot = name.find('.');
      values[name] = settings.at(name.substr(0, dot)).at(name.substr(dot + 1));
    }
    points.push_back(std::move(values));
  }
  return {{"map", name(sweep.map)}, {"varied", sweep.varied}, {"points", points}};
}

Json suite_json(const Suite& suite) {
  Json levels = Json::array(), systems = Json::array(), labels = Json::array();
  Json environments = Json::array();
  for (const Environment& e : suite.environments)
    environments.push_back(environment_json(suite, e));
  for (const auto& level : suite.levels)
    levels.push_back(level == kRecordedLevel ? kRecordedLevel : from_suite(suite, level));
  for (const SystemSpec& system : suite.systems) systems.push_back(system_json(system));
  for (const LabelMode mode : suite.labels) labels.push_back(name(mode));
  return {
      {"name", suite.name},
      {"environments", environments},
      {"vocabulary", suite.vocabulary.empty() ? Json() : Json(from_suite(suite, suite.vocabulary))},
      {"levels", levels},
      {"systems", systems},
      {"labels", labels},
      {"trials", suite.trials},
      {"frames", suite.max_frames ? Json(*suite.max_frames) : Json()},
      {"seed", suite.seed},
      {"slam", to_json(suite.slam)},
      {"parameters", sweep_json(suite.sweep)},
      {"non_inferiority_margin", number(suite.non_inferiority_margin)},
      {"protocol", to_json(suite.protocol)}};
}

Json path_json(const PathFacts& path) {
  return {{"frames", path.frames},
          {"length_m", number(path.length_m)},
          {"turned_in_place_rad", number(path.turned_in_place_rad)},
          {"contact_time_s", number(path.contact_time_s)},
          {"max_penetration_m", number(path.max_penetration_m)}};
}

Json place_json(const PlaceFacts& place) {
  Json inputs = Json::object();
  for (const InputDigest& input : place.inputs) inputs[input.name] = hex(input.digest);
  return {{"scene", place.scene},
          {"scene_digest", hex(place.scene_digest)},
          {"vocabulary_content_digest", hex(place.vocabulary_digest)},
          {"vocabulary_words", place.vocabulary_words},
          {"robot", place.robot},
          {"mapping_tour", path_json(place.mapping)},
          {"query_tour", place.second ? path_json(*place.second) : Json()},
          {"inputs", inputs}};
}

Json matches_json(const MatchCounts& matches) {
  Json all;
  for (std::size_t m = 0; m < matches.size(); ++m) {
    const MatcherCounts& c = matches[m];
    all[std::string(name(static_cast<Matcher>(m)))] = {{"compared", c.compared},
                                                       {"penalized", c.penalized},
                                                       {"rejected_by_xi", c.rejected_by_xi},
                                                       {"ratio_helped", c.ratio_helped}};
  }
  return all;
}

Json count_json(int count) {
  return count == kUnknownCount ? Json() : Json(count);
}

/// @param system  that answered
Json query_json(const QueryScore& q, const SystemSpec& system) {
  Json json = {
      {"frame", q.answer.index},
      {"stamp_ns", q.stamp_ns},
      {"success", q.success},
      {"correct", is_judged(q) ? Json(q.correct) : Json()},
      {"false", is_judged(q) ? Json(q.wrong) : Json()},
      {"stage", reports_stage(system, q.answer.stage) ? Json(name(q.answer.stage)) : Json()},
      {"attempts", q.answer.attempts},
      {"blank_frames", q.answer.blank_frames},
      {"truth", q.true_world_from_camera ? pose_json(*q.true_world_from_camera) : Json()}};
  if (q.success) {
    json["estimate"] = pose_json(*q.answer.world_from_camera);
    json["distance_m"] = number(q.distance_m);
    json["angle_deg"] = number(q.angle_deg);
    json["aligned_distance_m"] = number(q.aligned_distance_m);
  }
  if (const auto& c = q.answer.candidates)
    json["candidates"] = {{"keyframes", count_json(c->keyframes)},
                          {"c1", count_json(c->c1)},
                          {"c2", count_json(c->c2)},
                          {"c3", count_json(c->c3)},
                          {"final", count_json(c->final)},
                          {"label_mass", number(c->label_mass)}};
  return json;
}

Json trajectory_json(const TrajectoryScore& t) {
  return {{"completeness", t.completeness},
          {"ate_rmse_m", number(t.ate_rmse_m)},
          {"ate_first_pose_m", number(t.ate_first_pose_m)},
          {"rpe_frame_rmse_m", number(t.rpe_frame_rmse_m)},
          {"rpe_second_rmse_m", number(t.rpe_second_rmse_m)}};
}

Json summary_json(const QuerySummary& s) {
  if (s.queries == 0) return nullptr;  // nothing was asked
  return {{"queries", s.queries},
          {"success", s.success},
          {"correct", number(s.correct)},
          {"false", number(s.wrong)},
          {"distance_mean_m", number(s.distance_mean_m)},
          {"distance_median_m", number(s.distance_median_m)},
          {"aligned_distance_mean_m", number(s.aligned_distance_mean_m)},
          {"attempts", s.attempts},
          {"candidates",
           {{"keyframes", number(s.keyframes)},
            {"c1", number(s.c1)},
            {"c2", number(s.c2)},
            {"c3", number(s.c3)},
            {"final", number(s.final)},
            {"single", number(s.single_candidate)},
            {"label_mass", number(s.label_mass)}}}};
}

Json digests_json(const RunResult& run) {
  std::uint64_t images = 0, poses = 0;
  const auto chain = [](std::uint64_t& sum, std::uint64_t next) {
    sum = digest_bytes(&next, sizeof next, sum);
  };
  for (const MappedFrame& call : run.mapping.calls) {
    chain(images, call.image_digest);
    chain(poses, call.pose_digest);
  }
  for (const PointResult& point : run.points)
    for (const QuerySet set : kQuerySets)
      for (const QueryScore& q : queries(point, set)) {
        chain(images, q.answer.image_digest);
        chain(poses, q.answer.pose_digest);
      }
  return {
      {"images", hex(images)}, {"poses", hex(poses)}, {"trajectory", hex(digest(run.estimate))}};
}

/// What an outside program does not have or tell.
Json of_ours(const SystemSpec& system, const Json& value) {
  return system.is_program() ? Json() : value;
}

Json points_json(const RunResult& run) {
  Json points = Json::array();
  for (std::size_t i = 0; i < run.points.size(); ++i) {
    Json point = {{"settings", of_ours(run.spec.system, to_json(run.spec.points[i]))}};
    for (const QuerySet set : kQuerySets) {
      Json list = Json::array();
      for (const QueryScore& q : queries(run.points[i], set))
        list.push_back(query_json(q, run.spec.system));
      point[std::string(name(set))] = std::move(list);
    }
    points.push_back(std::move(point));
  }
  return points;
}

Json loops_json(const LoopAudit& loops) {
  const bool judged = loops.closed == 0 || loops.unknown < loops.closed;
  return {{"closed", loops.closed},
          {"false", judged ? Json(loops.wrong) : Json()},
          {"worst_m", judged ? Json(loops.worst_m) : Json()},
          {"worst_deg", judged ? Json(loops.worst_rad * 180.0 / std::numbers::pi) : Json()}};
}

Json run_json(const RunResult& run) {
  const MappingOutcome& m = run.mapping;
  Json trajectory = trajectory_json(run.trajectory);
  trajectory["offered"] = run.trajectory.offered;
  trajectory["tracked"] = run.trajectory.tracked;
  std::size_t keyframes = 0;
  for (const MappedFrame& call : m.calls) keyframes += call.keyframe_added ? 1 : 0;
  return {{"name", run.spec.name},
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
           {{"settings", of_ours(run.spec.system, to_json(run.spec.slam))},
            {"track_calls", m.calls.size()},
            {"failures", m.failures},
            {"restarts", m.restarts},
            {"dropped", m.dropped},
            {"before_map", m.before_map},
            {"gave_up", m.gave_up},
            {"skipped", {{"frames", m.skipped.count}, {"reasons", m.skipped.reasons}}},
            {"keyframes_made", keyframes},
            {"loops", loops_json(audit_loops(m.loops, run.truth, run.spec.protocol))},
            {"matchers", of_ours(run.spec.system, matches_json(m.matches))}}},
          {"trajectory", trajectory},
          {"points", points_json(run)}};
}

Json failed_json(const FailedRun& run) {
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
          {"trajectory", known(trajectory_json(row.trajectory))},
          {"restarts", known(row.restarts)},
          {"dropped", known(row.dropped)},
          {"held_out", summary_json(row.held_out)},
          {"second_tour", summary_json(row.second_tour)},
          {"matchers", known(of_ours(suite.systems[row.system], matches_json(row.matches)))}};
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
          {"completeness", row.scenes > 0 ? Json(row.completeness) : Json()},
          {"ate_rmse_m", number(row.ate_rmse_m)},
          {"rpe_frame_rmse_m", number(row.rpe_frame_rmse_m)},
          {"held_out", summary_json(row.held_out)},
          {"second_tour", summary_json(row.second_tour)}};
}

Json comparison_json(const Suite& suite, const SystemPair& systems, const Comparison& c) {
  const std::string& first = suite.systems[systems.first].name;
  const std::string& second = suite.systems[systems.second].name;
  const Verdict v = verdict(c);
  const auto known = [&](double value) { return c.pairs > 0 ? number(value) : Json(); };
  return {{"what", c.what},
          {"first", first},
          {"second", second},
          {"pairs", c.pairs},
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
  for (const FailedRun& run : failed) run_list.push_back(failed_json(run));
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
        if (suite.non_inferiority_margin && c.what.starts_with("success"))
          json["not_inferior"] = not_inferior(c, *suite.non_inferiority_margin);
        over_scenes.push_back(std::move(json));
      }
  }
  return {
      {"format", kResultsFormat},
      {"versions", {{"modelhouse", MH_VERSION}, {"compiler", __VERSION__}, {"opencv", CV_VERSION}}},
      {"suite", suite_json(suite)},
      {"rows", row_list},
      {"comparisons", comparisons},
      {"categories", categories},
      {"comparisons_over_scenes", over_scenes},
      {"runs", run_list},
      {"missing", missing}};
}

Json reproduction_json(const Suite& suite, std::span<const RunResult> runs) {
  const auto from_anywhere = [](const std::filesystem::path& file) {
    return shell_quoted(std::filesystem::absolute(file).lexically_normal().string());
  };
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  std::string command = (error ? std::string("modelhouse") : from_anywhere(program)) + " bench " +
                        from_anywhere(suite.file);
  if (suite.scene_replaced) {
    const std::filesystem::path& scene = suite.environments.front().scene;
    command +=
        " --scene " + (is_generated(scene) ? shell_quoted(scene.string()) : from_anywhere(scene));
  }
  if (suite.environments.size() == 1) {
    const SceneFrame& frame = suite.environments.front().frame;
    if (frame.up) command += fmt::format(" --up {}", name(*frame.up));
    if (frame.floor_z_m) command += fmt::format(" --floor-z {}", *frame.floor_z_m);
  }
  for (const auto& [name, value] : suite.set)
    command += " --set " + shell_quoted(fmt::format("{}={}", name, value));
  command += fmt::format(" --trials {}", suite.trials);
  if (suite.max_frames) command += fmt::format(" --frames {}", *suite.max_frames);
  Json seeds = Json::array(), inputs = Json::object(), files = Json::object();
  for (int trial = 0; trial < suite.trials; ++trial)
    seeds.push_back(suite.seed + static_cast<std::uint64_t>(trial));
  for (const RunResult& run : runs)
    for (const InputDigest& input : run.place.inputs)
      inputs[run.spec.environment.name][input.name] = hex(input.digest);
  for (const RunResult& run : runs)
    for (const InputDigest& input : run.place.inputs)
      for (const FileDigest& file : input.files)
        files[run.spec.environment.name][input.name][file.file] = hex(file.digest);
  return {{"command", command},         {"commit", built_commit()},
          {"code", code_of_run()},      {"build_and_machine", fingerprint_json()},
          {"suite", suite_json(suite)}, {"seeds", seeds},
          {"inputs", inputs},           {"files", files}};
}

Json times_json(std::span<const RunResult> runs) {
  Json list = Json::array();
  for (const RunResult& run : runs) {
    const auto calls = [](const std::vector<double>& times_ms) -> Json {
      if (times_ms.empty()) return nullptr;
      const TimeSummary t = summarize(times_ms);
      return {{"median", t.median_ms}, {"p95", t.p95_ms}};
    };
    list.push_back({{"name", run.spec.name},
                    {"wall_s", run.wall_s},
                    {"host", run.circumstances.host},
                    {"sitting", run.circumstances.sitting},
                    {"jobs", run.circumstances.jobs},
                    {"load_per_processor", run.circumstances.load},
                    {"track_ms", calls(run.times.track_ms)},
                    {"relocalize_ms", calls(run.times.relocalize_ms)},
                    {"blank_ms", calls(run.times.blank_ms)}});
  }
  return {{"fingerprint", fingerprint_json()}, {"runs", list}};
}

}  // namespace mh
