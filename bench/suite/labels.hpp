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

/// The origin of a run's labels: a kind that is rendered from a scene or recorded, or a real
/// detector, whose labels replace those of the frames (the kind is then kNone). A rendered kind may
/// have label noise of its own, called a dose.
struct Labels {
  LabelMode mode = LabelMode::kNone;
  std::optional<DetectorSpec> detector = {};
  std::optional<LabelNoiseConfig> dials = {};  ///< label noise in place of the level's
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

/// "exact", "none"; for a detector or a dose, its own name.
std::string name(const Labels& labels);
/// For texts: "exact labels", "labels from boxes", "no labels", "labels from yolox_nano", "exact
/// labels, confused_25".
std::string with_labels(const Labels& labels);

/// Reads a kind of labels, or a mapping. A mapping for a dose has `of` (a kind that is rendered
/// from a scene), `name` and fields of LabelNoiseConfig; one for a detector has the fields of
/// read_detector() and `name`, which defaults to the name of the network's or the boxes' file.
/// @param folder  what its paths are relative to
/// @throws InputError naming file, line and value
Labels read_label_source(YamlReader node, const std::filesystem::path& folder);

/// A level's sensors with the labels' own noise, if they have any.
SensorConfig with_dials(SensorConfig level, const Labels& labels);

/// The file that a detector is named after: its network or its boxes.
const std::filesystem::path& source_of(const DetectorSpec& spec);

}  // namespace mh
