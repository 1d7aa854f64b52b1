// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/run_key.hpp"

#include "bench/suite/code_version.hpp"
#include "bench/suite/fingerprint.hpp"
#include "bench/suite/spec_json.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/core/digest.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Returns everything that determines a result, by content rather than by names and paths.
nlohmann::ordered_json determining(const RunSpec& spec, std::span<const InputDigest> inputs) {
  nlohmann::ordered_json json = to_json(spec);
  if (spec.environment.suite_states_readout) json["suite_states_readout"] = true;
  if (spec.system.is_outside()) json["system"]["outside"].erase("folder");
  for (const char* named : {"name", "environment", "level", "vocabulary"}) json.erase(named);
  if (json["labels"].is_object())
    for (const char* named : {"name", "network", "config", "classes", "boxes"})
      json["labels"].erase(named);
  for (const InputDigest& input : inputs) json["inputs"][input.name] = hex(input.digest);
  if (spec.environment.frame != SceneFrame{}) json["scene_frame"] = to_json(spec.environment.frame);
  json["code"] = code_of_run();
  json["build"] = build_json();
  return json;
}

}  // namespace

std::string run_key(const RunSpec& spec, std::span<const InputDigest> inputs) {
  return text_key(determining(spec, inputs).dump());
}

void require_key(const RunSpec& spec, std::span<const InputDigest> read, const std::string& key) {
  if (run_key(spec, read) != key) throw_changed(spec);
}

void throw_changed(const RunSpec& spec) {
  throw InputChanged(fmt::format(
      "{}: a file that it reads was changed after the command began: start it again", spec.name));
}

std::string map_key(const RunSpec& spec, std::span<const InputDigest> inputs) {
  nlohmann::ordered_json json = determining(spec, inputs);
  json.erase("points");
  json.erase("trial");  // implied by the seed
  json["system"].erase("name");
  json.erase("graded");
  json["inputs"].erase("queries");
  sources(spec.environment, [&](const WorldSource& source, const auto&) {
    if (source.of_queries) json["inputs"].erase(source.key);
  });
  for (const char* of_queries : {"query_attempts", "attempts", "max_blank_frames",
                                 "correct_distance_m", "correct_angle_deg", "truth"})
    json["protocol"].erase(of_queries);
  return text_key(json.dump());
}

std::string stored_spec(const RunSpec& spec) {
  nlohmann::ordered_json json = to_json(spec);
  const auto name_of = [](const fs::path& source) {
    return is_generated(source) ? source.string() : source.filename().string();
  };
  nlohmann::ordered_json& e = json["environment"];
  if (spec.environment.is_recorded()) {
    const auto shorten_sequence = [&](const char* key, const std::string& source) {
      const auto [layout, path] = split_sequence(source);
      e["recording"][key] = join_sequence(layout, name_of(path));
    };
    shorten_sequence("sequence", spec.environment.sequence);
    if (spec.environment.queries) shorten_sequence("queries", *spec.environment.queries);
    for (const auto& [key, file] :
         {std::pair("settings", spec.environment.settings), {"classes", spec.environment.classes}})
      if (file) e["recording"][key] = name_of(*file);
  }
  sources(spec.environment, [&](const WorldSource& source, const std::optional<fs::path>& path) {
    if (path) e[source.key] = name_of(*path);
  });
  json["level"] = level_name(spec.level);
  if (const auto& detector = spec.labels.detector)
    for (const auto& [key, file] : {std::pair("network", detector->network),
                                    {"config", detector->config},
                                    {"classes", detector->classes},
                                    {"boxes", detector->boxes}})
      json["labels"][key] = file.filename().string();
  json["vocabulary"] = name_of(spec.vocabulary);
  if (spec.system.is_outside()) json["system"]["outside"].erase("folder");
  return json.dump();
}

}  // namespace mh
