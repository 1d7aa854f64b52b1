// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "sim/sensors/config.hpp"
#include "sim/sensors/labels.hpp"
#include "slam/detect/settings.hpp"
#include "slam/io/words.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

constexpr Names<LabelMode, 6> words(LabelMode) {
  return {{{"exact", LabelMode::kExact},
           {"annotated", LabelMode::kAnnotated},
           {"boxes", LabelMode::kBoxes},
           {"detector", LabelMode::kDetector},
           {"none", LabelMode::kNone},
           {"recorded", LabelMode::kRecorded}}};
}
constexpr std::string_view name(LabelMode labels) {
  return name_of(labels, words(labels));
}

/// The origin of a run's labels: a kind that is drawn of a scene or recorded, or a real detector,
/// whose labels replace those of the frames (then the kind is kNone). A kind that is drawn may have
/// faults of its own: a dose of them.
struct Labels {
  LabelMode mode = LabelMode::kNone;
  std::optional<DetectorSpec> detector = {};
  std::optional<LabelNoiseConfig> dials = {};  ///< in place of the level's
  std::string called = {};  ///< name of a detector or a dose in reports, unique in its suite

  Labels() = default;
  Labels(LabelMode kind) : mode(kind) {}  // NOLINT: a kind is the usual case
  Labels(DetectorSpec spec, std::string name)
      : detector(std::move(spec)), called(std::move(name)) {}
  Labels(LabelMode kind, const LabelNoiseConfig& dose, std::string name)
      : mode(kind), dials(dose), called(std::move(name)) {}
  friend bool operator==(const Labels&, const Labels&) = default;
};

template <MaybeConst<Labels> L, class Visit>
void fields(L& labels, Visit& v) {
  auto& [mode, detector, dials, called] = labels;
  v("mode", mode);
  v("detector", detector);
  v("dials", dials);
  v("called", called);
}

/// "exact", "none"; the own name of a detector or a dose.
std::string name(const Labels& labels);
/// "exact labels", "labels from boxes", "no labels", "labels from yolox_nano", "exact labels,
/// confused_25"
std::string with_labels(const Labels& labels);

/// Reads a kind of labels; or a mapping: `of` (a kind that is drawn of a scene), `name` and fields
/// of LabelNoiseConfig, or that of read_detector() with `name`, which defaults to that of the
/// network's or the boxes' file.
/// @param folder  what its paths are relative to
/// @throws InputError naming file, line and value
Labels read_label_source(YamlReader node, const std::filesystem::path& folder);

/// The sensors of a level as a run with these labels has them.
SensorConfig with_dials(SensorConfig level, const Labels& labels);

/// The file that a detector is named after: its network or its boxes.
const std::filesystem::path& source_of(const DetectorSpec& spec);

}  // namespace mh
