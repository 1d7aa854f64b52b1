// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/inputs.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "bench/suite/find_program.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "robots/model/robot.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/load.hpp"
#include "sim/motion/motion.hpp"
#include "sim/sensors/sense.hpp"
#include "sim/simulation/pedestrian.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/core/digest.hpp"
#include "slam/detect/detector.hpp"
#include "slam/io/words.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A file's path relative to the folder of the source that names it, so that it does not depend on
/// where that folder is.
std::string name_from(const fs::path& source, const fs::path& file) {
  if (is_generated(source)) return file.filename().string();
  std::error_code error;
  const fs::path absolute = fs::absolute(source, error).lexically_normal();
  const fs::path folder = fs::is_directory(source, error) ? absolute : absolute.parent_path();
  return fs::absolute(file, error).lexically_normal().lexically_relative(folder).generic_string();
}

/// The names of the kinds: a file is read once per kind.
constexpr Names<SourceKind, 6> kKinds{{{"scene", SourceKind::kScene},
                                       {"motion", SourceKind::kMotion},
                                       {"tour", SourceKind::kTour},
                                       {"robot", SourceKind::kRobot},
                                       {"level", SourceKind::kLevel},
                                       {"pedestrian", SourceKind::kPedestrian}}};

}  // namespace

InputDigest input_of(std::string name, const fs::path& source, const ReadRecord& record) {
  InputDigest input{.name = std::move(name), .digest = digest(record)};
  if (is_generated(source)) {
    const std::string text = source.string();
    input.digest = digest_bytes(text.data(), text.size(), input.digest);
  }
  for (const FileObservation& o : record.observations)
    if (o.kind == FileObservation::Kind::kRead)
      input.files.push_back({name_from(source, o.path), o.digest});
  std::ranges::sort(input.files);
  const auto repeated = std::ranges::unique(input.files);
  input.files.erase(repeated.begin(), repeated.end());
  return input;
}

std::vector<InputDigest> inputs_of_program(const SystemSpec& system) {
  std::vector<InputDigest> inputs;
  if (!system.is_outside()) return inputs;
  for (const ProgramFile& file : files_of(*system.outside)) {
    const std::uint64_t content = digest_file(file.file);
    inputs.push_back({fmt::format("{}: {}", system.name, file.word), content, {}});
  }
  for (const auto& [name, value] : variables_of(*system.outside))
    inputs.push_back({fmt::format("{}: ${}", system.name, name),
                      value ? digest_bytes(value->data(), value->size()) : 0,
                      {}});
  return inputs;
}

std::vector<InputDigest> InputReader::inputs_of(const Environment& e) {
  std::vector<InputDigest> inputs;
  if (e.is_recorded()) {
    // What is read from a recording also depends on the files given with it.
    const std::string beside = fmt::format("{} {} {}", e.settings.value_or("").string(),
                                           e.classes.value_or("").string(), e.topics);
    const auto add = [&](const char* name, const std::string& sequence) {
      // One folder may be read as several layouts.
      const auto [layout, path] = split_sequence(sequence);
      const std::string kind = fmt::format("{} recording {}", layout, beside);
      inputs.push_back(read(name, kind, path, [&](const fs::path& file) {
        say_(fmt::format("reading {}", file.string()));
        const OpenedRecording opened = open_recorded(e, sequence);
        image_digests_[sequence] = opened.image_digests;
        for (const std::string& note : opened.notes) warn(note);
      }));
    };
    add("sequence", e.sequence);
    if (e.queries) add("queries", *e.queries);
    return inputs;
  }
  for (const bool of_scenes :
       {false, true})  // scenes take the longest: other errors are reported first
    sources(e, [&](const WorldSource& source, const std::optional<fs::path>& path) {
      if (path && (source.kind == SourceKind::kScene) == of_scenes)
        inputs.push_back(this->source(source.key, source.kind, *path, e.frame));
    });
  return inputs;
}

std::vector<InputDigest> InputReader::inputs_of(const EpisodesSpec& episodes) {
  std::vector<InputDigest> inputs;
  for (const EpisodeVariant& variant : episodes.variants)
    sources(variant, [&](const WorldSource& source, const std::optional<fs::path>& path) {
      if (path) inputs.push_back(this->source(input_name(variant, source), source.kind, *path, {}));
    });
  return inputs;
}

std::vector<InputDigest> InputReader::inputs_of(const RunSpec& spec) {
  std::vector<InputDigest> inputs = inputs_of(spec.environment);
  if (spec.level.is_file()) inputs.push_back(level(spec.level.file));
  if (const auto& detector = labels_of_frames(spec).detector)
    inputs.push_back(this->detector(*detector));
  if (!spec.vocabulary.empty()) inputs.push_back(vocabulary(spec.vocabulary));
  if (spec.episodes) std::ranges::move(inputs_of(*spec.episodes), std::back_inserter(inputs));
  std::ranges::copy(program(spec.system), std::back_inserter(inputs));
  std::ranges::sort(inputs, {}, &InputDigest::name);
  return inputs;
}

InputDigest InputReader::level(const fs::path& file) {
  return read("level", "level", file, [](const fs::path& f) { load_sensor_config(f); });
}

InputDigest InputReader::detector(const DetectorSpec& spec) {
  return read("detector",
              fmt::format("detector {} {}", spec.config.string(), spec.classes.string()),
              source_of(spec), [&](const fs::path&) { open_detector(spec); });
}

InputDigest InputReader::vocabulary(const fs::path& file) {
  return read("vocabulary", "vocabulary", file, [](const fs::path& f) { Vocabulary::load(f); });
}

const std::vector<InputDigest>& InputReader::program(const SystemSpec& system) {
  const auto [found, is_new] = of_program_.try_emplace(system.name);
  if (is_new) found->second = inputs_of_program(system);
  return found->second;
}

bool InputReader::share_images(const std::string& a, const std::string& b) const {
  const std::vector<std::uint64_t>&one = image_digests_.at(a), &other = image_digests_.at(b);
  std::vector<std::uint64_t> both;
  std::ranges::set_intersection(one, other, std::back_inserter(both));
  return 2 * both.size() > std::min(one.size(), other.size());
}

std::shared_ptr<const Scene> InputReader::scene(const fs::path& file, const SceneFrame& frame) {
  if (scene_ == nullptr || scene_source_ != std::pair(file, frame)) {
    say_(fmt::format("reading {}", file.string()));
    forget_scene();                     // before loading the next: two may not fit in memory
    std::vector<std::string> warnings;  // reported only here: the runs load the scene again
    scene_ = std::make_shared<const Scene>(load_scene(file, &warnings, frame));
    scene_source_ = {file, frame};
    for (const std::string& warning : warnings) warn(warning);
  }
  return scene_;
}

void InputReader::warn(const std::string& warning) {
  if (warned_.insert(warning).second) say_("warning: " + warning);
}

InputDigest InputReader::source(std::string name, SourceKind kind, const fs::path& path,
                                const SceneFrame& frame) {
  return read(std::move(name), std::string(name_of(kind, kKinds)), path,
              [&](const fs::path& file) { load(kind, file, frame); });
}

void InputReader::load(SourceKind kind, const fs::path& file, const SceneFrame& frame) {
  std::vector<std::string> warnings;
  switch (kind) {
    case SourceKind::kScene:
      if (is_generated(file))  // depends only on its name; expensive to create
        return static_cast<void>(parse_generated(file.string()));
      forget_scene();  // so that it is read again: only what is read now is noted
      return static_cast<void>(scene(file, frame));
    case SourceKind::kMotion:
      return check_motion(file);
    case SourceKind::kTour:
      return static_cast<void>(load_tour(file));
    case SourceKind::kLevel:
      return static_cast<void>(load_sensor_config(file));
    case SourceKind::kPedestrian:
      return static_cast<void>(load_pedestrian(file));
    case SourceKind::kRobot:
      load_robot(file, &warnings);
      for (const std::string& warning : warnings) warn(warning);
  }
}

InputDigest InputReader::read(std::string name, const std::string& kind, const fs::path& source,
                              const std::function<void(const fs::path&)>& load) {
  const std::pair key(kind, source);
  auto known = known_.find(key);
  if (known == known_.end()) {
    const ReadScope scope;
    load(source);
    known = known_.emplace(key, input_of(kind, source, scope.record())).first;
  }
  InputDigest input = known->second;
  input.name = std::move(name);
  return input;
}

}  // namespace mh
