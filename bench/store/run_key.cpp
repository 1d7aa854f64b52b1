// SPDX-License-Identifier: Apache-2.0
#include "bench/store/run_key.hpp"

#include <xxhash.h>

#include <algorithm>

#include <fmt/format.h>

#include "bench/plan/spec_json.hpp"
#include "bench/protocol/digest.hpp"
#include "bench/results/fingerprint.hpp"
#include "bench/store/code_version.hpp"
#include "bench/systems/find_program.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// The file, and for a mesh what lies beside it under the same name.
std::vector<fs::path> parts_of(const fs::path& file) {
  std::vector<fs::path> parts = {file};
  const std::string ending = file.extension().string();
  if (ending == ".yaml" || ending == ".yml") return parts;
  const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const fs::path name = entry.path().filename();
    if (entry.is_regular_file(error) && name != file.filename() &&
        name.string().starts_with(file.stem().string() + "."))
      parts.push_back(entry.path());
  }
  std::sort(parts.begin() + 1, parts.end());
  return parts;
}

std::uint64_t digest_source(const fs::path& source) {
  if (is_generated(source)) {
    const std::string text = source.string();
    return digest_bytes(text.data(), text.size());
  }
  std::uint64_t sum = 0;
  for (const fs::path& part : parts_of(source)) sum = digest_file(part, sum);
  return sum;
}

}  // namespace

std::vector<InputDigest> digest_inputs(const RunSpec& spec) {
  const Environment& e = spec.environment;
  std::vector<InputDigest> inputs;
  const auto add = [&](std::string name, const fs::path& source) {
    inputs.push_back({std::move(name), digest_source(source)});
  };
  add("scene", e.scene);
  add("robot", e.robot);
  add("mapping_tour", e.mapping_tour);
  if (e.query_tour) add("query_tour", *e.query_tour);
  if (e.query_scene) add("query_scene", *e.query_scene);
  if (e.kidnapped_tour) add("kidnapped_tour", *e.kidnapped_tour);
  if (e.sensors) add("sensors", *e.sensors);
  if (e.walk) add("walk", *e.walk);
  add("vocabulary", spec.vocabulary);
  add("level", spec.level);
  if (spec.system.kind == SystemKind::kOutside)
    for (const ProgramFile& file : files_of(spec.system.outside))
      inputs.push_back(
          {fmt::format("{}: {}", spec.system.name, file.word), digest_file(file.file)});
  return inputs;
}

namespace {

/// All that determines a result, by content instead of by names and paths.
nlohmann::ordered_json determining(const RunSpec& spec) {
  nlohmann::ordered_json json = to_json(spec);
  if (spec.system.kind == SystemKind::kOutside) json["system"]["outside"].erase("folder");
  for (const char* named : {"name", "environment", "level", "vocabulary"}) json.erase(named);
  for (const InputDigest& input : digest_inputs(spec))
    json["inputs"][input.name] = hex(input.digest);
  json["code"] = code_of_run();
  json["build"] = build_json();
  return json;
}

}  // namespace

std::string run_key(const RunSpec& spec) {
  return text_key(determining(spec).dump());
}

std::string map_key(const RunSpec& spec) {
  nlohmann::ordered_json json = determining(spec);
  json.erase("points");
  json.erase("trial");  // the seed tells
  json["system"].erase("name");
  for (const char* of_queries : {"query_tour", "query_scene"}) json["inputs"].erase(of_queries);
  for (const char* of_queries :
       {"query_attempts", "max_blank_frames", "correct_distance_m", "correct_angle_deg", "truth"})
    json["protocol"].erase(of_queries);
  return text_key(json.dump());
}

std::string stored_spec(const RunSpec& spec) {
  nlohmann::ordered_json json = to_json(spec);
  const auto name_of = [](const fs::path& source) {
    return is_generated(source) ? source.string() : source.filename().string();
  };
  nlohmann::ordered_json& e = json["environment"];
  e["scene"] = name_of(spec.environment.scene);
  e["robot"] = name_of(spec.environment.robot);
  e["mapping_tour"] = name_of(spec.environment.mapping_tour);
  const auto shorten = [&](const char* key, const std::optional<fs::path>& source) {
    if (source) e[key] = name_of(*source);
  };
  shorten("query_tour", spec.environment.query_tour);
  shorten("query_scene", spec.environment.query_scene);
  shorten("kidnapped_tour", spec.environment.kidnapped_tour);
  shorten("sensors", spec.environment.sensors);
  shorten("walk", spec.environment.walk);
  json["level"] = level_name(spec.level);
  json["vocabulary"] = name_of(spec.vocabulary);
  if (spec.system.kind == SystemKind::kOutside) json["system"]["outside"].erase("folder");
  return json.dump();
}

std::string text_key(std::string_view text) {
  const XXH128_hash_t h = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", h.high64, h.low64);
}

}  // namespace mh
