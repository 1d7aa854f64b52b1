// SPDX-License-Identifier: Apache-2.0
#include "bench/report/suite_json.hpp"

#include <optional>

#include "bench/suite/json_fields.hpp"
#include "bench/suite/shipped.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/config/slam.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

/// A file's path relative to the suite's folder, however the path of the suite was given. If a
/// suite outside the shipped folder uses a shipped file, the path is relative to the shipped
/// folder.
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
  Json json = {{"name", e.name},
               {"category", e.category},
               {"sequence", name_of(e.sequence)},
               {"queries", e.queries ? Json(name_of(*e.queries)) : Json()},
               {"settings", e.settings ? Json(from_suite(suite, *e.settings)) : Json()},
               {"classes", e.classes ? Json(from_suite(suite, *e.classes)) : Json()}};
  if (!e.topics.empty()) json["topics"] = e.topics;
  return json;
}

Json environment_json(const Suite& suite, const Environment& e) {
  if (e.is_recorded()) return recorded_json(suite, e);
  Json json = {{"name", e.name}, {"category", e.category}};
  sources(e, [&](const WorldSource& source, const std::optional<std::filesystem::path>& path) {
    json[source.key] = path ? source_json(suite, *path) : Json();
  });
  json.update(json_of(e.frame));
  return json;
}

Json compare_json(const Suite& suite) {
  Json pairs = Json::array();
  for (const SystemPair& pair : suite.compare)
    pairs.push_back({suite.systems[pair.first].name, suite.systems[pair.second].name});
  return pairs;
}

Json episodes_json(const Suite& suite) {
  if (!suite.episodes) return nullptr;
  const EpisodesSpec& spec = *suite.episodes;
  Json variants = Json::array();
  for (const EpisodeVariant& variant : spec.variants) {
    Json json = {{"name", variant.name}};
    sources(variant, [&](const WorldSource& source, const auto& file) {
      if (file) json[source.key] = source_json(suite, *file);
    });
    variants.push_back(std::move(json));
  }
  Json json = json_of(spec);
  json["variants"] = variants;
  return json;
}

Json system_json(const SystemSpec& system) {
  if (!system.is_outside() && system.settings.empty()) return system.name;
  if (!system.is_outside()) {
    Json slam = Json::object();
    for (const auto& [setting, value] : system.settings) slam[setting] = value.as_string();
    return {{"name", system.name}, {"system", name(system.kind)}, {"slam", slam}};
  }
  const OutsideProgram& p = *system.outside;
  if (p.is_library())
    return {{"name", system.name},
            {"library", p.library},
            {"settings", p.settings},
            {"inputs", p.inputs}};
  return {{"name", system.name},
          {"command", p.command},
          {"protocol", name(p.mode)},
          {"inputs", p.inputs}};
}

Json sweep_json(const Sweep& sweep) {
  if (sweep.points.empty()) return nullptr;
  Json points = Json::array();
  for (const SlamConfig& point : sweep.points) {
    Json values;
    const Json settings = json_of(point);
    for (const std::string& name : sweep.varied) {
      const std::size_t dot = name.find('.');
      values[name] = settings.at(name.substr(0, dot)).at(name.substr(dot + 1));
    }
    points.push_back(std::move(values));
  }
  return {{"map", name(sweep.map)}, {"varied", sweep.varied}, {"points", points}};
}

}  // namespace

Json suite_json(const Suite& suite) {
  const auto level_json = [](const Suite& of, const Level& level) {
    const std::string file = level.is_file() ? from_suite(of, level.file) : kRecordedLevel;
    return level.doses.empty() ? Json(file) : Json{{"file", file}, {"doses", json_of(level.doses)}};
  };
  Json levels = Json::array(), systems = Json::array(), labels = Json::array();
  Json environments = Json::array();
  for (const Environment& e : suite.environments)
    environments.push_back(environment_json(suite, e));
  for (const auto& level : suite.levels) levels.push_back(level_json(suite, level));
  for (const SystemSpec& system : suite.systems) systems.push_back(system_json(system));
  for (const Labels& mode : suite.labels) labels.push_back(name(mode));
  Json json = {
      {"name", suite.name},
      {"environments", environments},
      {"vocabulary", suite.vocabulary.empty() ? Json() : Json(from_suite(suite, suite.vocabulary))},
      {"levels", levels},
      {"systems", systems},
      {"labels", labels},
      {"senses", json_of(suite.senses)},
      {"frames", json_of(suite.max_frames)},
      {"slam", json_of(suite.slam)},
      {"parameters", sweep_json(suite.sweep)},
      {"graded", json_of(suite.graded)},
      {"episodes", episodes_json(suite)},
      {"compare", compare_json(suite)},
      {"published_ate_m", suite.published_ate_m},
      {"protocol", json_of(suite.protocol)}};
  json.update(json_of(suite));  // the suite's single values
  return json;
}

}  // namespace mh
