// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/run_key.hpp"

#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "bench/suite/code_version.hpp"
#include "bench/suite/fingerprint.hpp"
#include "bench/suite/run_spec.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/read_record.hpp"
#include "slam/io/setting.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Calls visit(path) for each path of a record, however deep.
template <class T, class Visit>
void for_each_path(T& value, const Visit& visit) {
  if constexpr (std::is_same_v<T, fs::path>) {
    visit(value);
  } else if constexpr (kIsOptional<T>) {
    if (value) for_each_path(*value, visit);
  } else if constexpr (kIsVector<T>) {
    for (auto& element : value) for_each_path(element, visit);
  } else if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string> && !kIsShared<T>) {
    for_each_field(value, [&](const auto&, auto& field) { for_each_path(field, visit); });
  }
}

/// Returns everything that determines a result, by content rather than by names and paths.
nlohmann::ordered_json determining(RunSpec spec, std::span<const InputDigest> inputs) {
  for (std::string* name :
       {&spec.name, &spec.environment.name, &spec.environment.category, &spec.environment.sequence,
        &spec.labels.called, &spec.map_labels.called})
    name->clear();
  spec.environment.queries.reset();
  for_each_path(spec, [](fs::path& path) { path.clear(); });
  nlohmann::ordered_json json = to_json(spec);
  json["inputs"] = nlohmann::ordered_json::object();
  for (const InputDigest& input : inputs) json["inputs"][input.name] = hex(input.digest);
  json["code"] = code_of_run();
  json["build"] = build_json();
  return json;
}

/// The last part of a path: the name of a file, regardless of where it is.
fs::path name_of(const fs::path& source) {
  return is_generated(source) ? source : source.filename();
}

std::string name_of_recording(const std::string& sequence) {
  const auto [layout, path] = split_sequence(sequence);
  return join_sequence(layout, name_of(path));
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
  RunSpec mapping = spec;
  mapping.trial = 0;  // implied by the seed
  mapping.system.name.clear();
  mapping.points.clear();
  mapping.graded.reset();
  if (spec.episodes)
    mapping.episodes = EpisodesSpec{.goals = {}, .ticks_per_frame = spec.episodes->ticks_per_frame};
  sources(mapping.environment, [](const WorldSource& source, auto& path) {
    if (source.of_queries) path = std::decay_t<decltype(path)>();
  });
  nlohmann::ordered_json json = determining(std::move(mapping), inputs);
  json["inputs"].erase("queries");
  if (spec.episodes)
    for (const EpisodeVariant& variant : spec.episodes->variants)
      sources(variant, [&](const WorldSource& source, const auto&) {
        json["inputs"].erase(input_name(variant, source));
      });
  sources(spec.environment, [&](const WorldSource& source, const auto&) {
    if (source.of_queries) json["inputs"].erase(source.key);
  });
  for (const char* setting : kProtocolOfQueries) json["protocol"].erase(setting);
  return text_key(json.dump());
}

std::string stored_spec(const RunSpec& spec) {
  RunSpec stored = spec;
  for_each_path(stored, [](fs::path& path) { path = name_of(path); });
  stored.level.file = spec.level.file.stem();
  Environment& e = stored.environment;
  if (e.is_recorded()) e.sequence = name_of_recording(e.sequence);
  if (e.queries) e.queries = name_of_recording(*e.queries);
  if (stored.system.outside) stored.system.outside->folder.clear();
  return to_json(stored).dump();
}

}  // namespace mh
