// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/spec_json.hpp"

#include <fmt/format.h>

#include "slam/config/slam.hpp"
#include "slam/io/error.hpp"
#include "slam/io/json_number.hpp"
#include "slam/io/json_text.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

/// The enumerator whose name() is the word.
template <class T>
T named(const Json& word, std::initializer_list<T> values) {
  for (const T value : values)
    if (name(value) == word.get<std::string>()) return value;
  throw InputError(fmt::format("'{}' is not a known word", word.get<std::string>()));
}

/// Writes settings into an object, or into a nested object per section.
class WriteSettings {
 public:
  explicit WriteSettings(Json& into) : all_(into), into_(&into) {}
  void section(const char* name) { into_ = &all_[name]; }
  template <class T>
  void operator()(const char* key, const T& value, const SettingRange&, const char*) {
    if constexpr (std::is_enum_v<T>)
      (*into_)[key] = SettingsWriter::word_of(value);
    else
      (*into_)[key] = value;
  }

 private:
  Json& all_;
  Json* into_;
};

/// The inverse: reads them back.
class ReadSettings {
 public:
  explicit ReadSettings(const Json& from) : all_(from), from_(&from) {}
  void section(const char* name) { from_ = &all_.at(name); }
  template <class T>
  void operator()(const char* key, T& value, const SettingRange&, const char*) {
    if constexpr (std::is_enum_v<T>) {
      const std::string word = from_->at(key);
      const auto named = value_of(word, words(T{}));
      if (!named) throw InputError(fmt::format("'{}' is not a known word", word));
      value = *named;
    } else {
      value = from_->at(key).template get<T>();
    }
  }

 private:
  const Json& all_;
  const Json* from_;
};

/// Writes the fields of one section, without its name.
template <class Config>
Json section_json(const Config& config) {
  Json json;
  WriteSettings write(json);
  fields(config, write);
  return json;
}

/// The inverse: reads them back.
template <class Config>
Config section_from(const Json& json) {
  Config config;
  ReadSettings read(json);
  fields(config, read);
  return config;
}

template <class T>
Json optional_json(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json to_json(const SystemSpec& system) {
  const OutsideProgram& p = system.outside;
  Json json = {{"kind", name(system.kind)}, {"name", system.name}};
  if (!system.is_outside()) return json;
  json["outside"] = {{"command", p.command}, {"mode", name(p.mode)}, {"folder", p.folder.string()},
                     {"inputs", p.inputs},   {"library", p.library}, {"settings", p.settings}};
  limits(p, [&](const char* key, double value, auto&&...) { json["outside"][key] = value; });
  return json;
}

SystemSpec system_from_json(const Json& json) {
  SystemSpec system{.kind = named(json.at("kind"), {SystemKind::kSemantic, SystemKind::kPlain,
                                                    SystemKind::kOutside}),
                    .name = json.at("name"),
                    .outside = {}};
  if (system.is_outside()) {
    const Json& p = json.at("outside");
    system.outside = {
        .name = system.name,
        .command = p.at("command"),
        .mode = named(p.at("mode"), {OutsideMode::kTrajectory, OutsideMode::kConversation,
                                     OutsideMode::kLibrary}),
        .folder = p.at("folder").get<std::string>(),
        .inputs = p.at("inputs").get<std::vector<std::string>>(),
        .library = p.at("library"),
        .settings = p.at("settings")};
    limits(system.outside, [&](const char* key, double& value, auto&&...) { value = p.at(key); });
  }
  return system;
}

Json path_json(const std::optional<std::filesystem::path>& path) {
  return path ? Json(path->string()) : Json();
}

std::optional<std::filesystem::path> path_from_json(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return json.get<std::string>();
}

Json to_json(const Environment& e) {
  Json json = {{"name", e.name}, {"category", e.category}};
  sources(e,
          [&](const WorldSource& source, const auto& path) { json[source.key] = path_json(path); });
  if (e.frame != SceneFrame{}) json["frame"] = to_json(e.frame);
  if (e.is_recorded())
    json["recording"] = {{"sequence", e.sequence},
                         {"queries", optional_json(e.queries)},
                         {"settings", path_json(e.settings)},
                         {"classes", path_json(e.classes)}};
  if (!e.topics.empty()) json["recording"]["topics"] = e.topics;
  if (e.suite_states_readout) json["recording"]["suite_states_readout"] = true;
  return json;
}

Environment environment_from_json(const Json& json) {
  Environment e;
  e.name = json.at("name");
  e.category = json.at("category");
  sources(e, [&](const WorldSource& source, auto& path) {
    if (const auto known = path_from_json(json.at(source.key))) path = *known;
  });
  if (json.contains("frame")) e.frame = scene_frame_from_json(json.at("frame"));
  if (!json.contains("recording")) return e;
  const Json& recording = json.at("recording");
  e.sequence = recording.at("sequence");
  if (!recording.at("queries").is_null()) e.queries = recording.at("queries").get<std::string>();
  e.settings = path_from_json(recording.at("settings"));
  e.classes = path_from_json(recording.at("classes"));
  e.topics = recording.value("topics", "");
  e.suite_states_readout = recording.value("suite_states_readout", false);
  return e;
}

Json labels_json(const Labels& labels) {
  if (labels.dials)
    return {
        {"name", labels.called}, {"of", name(labels.mode)}, {"dials", section_json(*labels.dials)}};
  if (!labels.detector) return name(labels.mode);
  const DetectorSpec& d = *labels.detector;
  return {{"name", labels.called},       {"network", d.network.string()},
          {"config", d.config.string()}, {"classes", d.classes.string()},
          {"boxes", d.boxes.string()},   {"settings", section_json(d.settings)}};
}

Labels labels_from_json(const Json& json) {
  const auto kind_of = [](const Json& word) {
    return named(word, {LabelMode::kNone, LabelMode::kExact, LabelMode::kAnnotated,
                        LabelMode::kBoxes, LabelMode::kDetector, LabelMode::kRecorded});
  };
  if (!json.is_object()) return kind_of(json);
  if (json.contains("of"))
    return {kind_of(json.at("of")), section_from<LabelNoiseConfig>(json.at("dials")),
            json.at("name")};
  const auto path = [&](const char* key) { return json.at(key).get<std::string>(); };
  return {{.network = path("network"),
           .config = path("config"),
           .classes = path("classes"),
           .boxes = path("boxes"),
           .settings = section_from<DetectorSettings>(json.at("settings"))},
          json.at("name")};
}

SlamConfig slam_from_json(const Json& json) {
  SlamConfig settings;
  for_each_setting(settings, ReadSettings(json));
  return settings;
}

RunSpec read(const Json& json) {
  RunSpec spec;
  spec.name = json.at("name");
  spec.environment = environment_from_json(json.at("environment"));
  spec.level = json.at("level").get<std::string>();
  spec.vocabulary = json.at("vocabulary").get<std::string>();
  spec.system = system_from_json(json.at("system"));
  spec.labels = labels_from_json(json.at("labels"));
  spec.trial = json.at("trial");
  spec.seed = json.at("seed");
  spec.slam = slam_from_json(json.at("slam"));
  for (const Json& point : json.at("points"))
    spec.points.push_back(section_from<SemanticConfig>(point));
  spec.protocol = section_from<ProtocolConfig>(json.at("protocol"));
  if (!json.at("graded").is_null()) spec.graded = section_from<GradedSpec>(json.at("graded"));
  if (!json.at("max_frames").is_null())
    spec.max_frames = whole_number<std::size_t>(json.at("max_frames"));
  return spec;
}

}  // namespace

Json to_json(const GradedSpec& graded) {
  return section_json(graded);
}

Json to_json(const EpisodesSpec& episodes) {
  return section_json(episodes);
}

Json to_json(const SceneFrame& frame) {
  Json json = Json::object();
  if (frame.up) json["up"] = name(*frame.up);
  if (frame.floor_z_m) json["floor_z_m"] = *frame.floor_z_m;
  return json;
}

Json to_json(const SemanticConfig& semantics) {
  return section_json(semantics);
}

Json to_json(const SlamConfig& settings) {
  Json json;
  for_each_setting(settings, WriteSettings(json));
  return json;
}

Json to_json(const ProtocolConfig& protocol) {
  return section_json(protocol);
}

Json to_json(const RunSpec& spec) {
  Json points = Json::array();
  for (const SemanticConfig& point : spec.points) points.push_back(to_json(point));
  return {{"name", spec.name},
          {"environment", to_json(spec.environment)},
          {"level", spec.level.string()},
          {"vocabulary", spec.vocabulary.string()},
          {"system", to_json(spec.system)},
          {"labels", labels_json(spec.labels)},
          {"trial", spec.trial},
          {"seed", spec.seed},
          {"slam", to_json(spec.slam)},
          {"points", points},
          {"protocol", to_json(spec.protocol)},
          {"graded", spec.graded ? to_json(*spec.graded) : Json()},
          {"max_frames", optional_json(spec.max_frames)}};
}

SceneFrame scene_frame_from_json(const Json& json) {
  SceneFrame frame;
  if (json.contains("up")) frame.up = up_axis(json.at("up").get<std::string>());
  if (json.contains("floor_z_m")) frame.floor_z_m = json.at("floor_z_m").get<double>();
  return frame;
}

RunSpec run_spec_from_json(const Json& json) {
  try {
    return read(json);
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("run description: {}", json_fault(error)));
  }
}

}  // namespace mh
