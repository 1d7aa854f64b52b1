// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/labels.hpp"

#include <fmt/format.h>

#include "bench/suite/names.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {
std::string name(const Labels& labels) {
  return labels.called.empty() ? std::string(name(labels.mode)) : labels.called;
}

std::string with_labels(const Labels& labels) {
  if (labels.detector) return fmt::format("labels from {}", labels.called);
  if (labels.dials) return fmt::format("{}, {}", with_labels(labels.mode), labels.called);
  switch (labels.mode) {
    case LabelMode::kExact:
      return "exact labels";
    case LabelMode::kAnnotated:
      return "annotated labels";
    case LabelMode::kBoxes:
      return "labels from boxes";
    case LabelMode::kDetector:
      return "labels from the detector";
    case LabelMode::kRecorded:
      return "recorded labels";
    case LabelMode::kNone:
      break;
  }
  return "no labels";
}

namespace {

/// Returns the name if it is valid and not a kind of labels.
std::string own_name(const YamlReader& node, const std::string& called) {
  check_folder_name(node, called);
  if (value_of(called, words(LabelMode{})))
    node.fail(fmt::format("'{}' is a kind of labels: use another name", called));
  return called;
}

/// Reads a dose: `{of: exact, name: confused_25, confusion: 0.25}`.
Labels read_dose(YamlReader node) {
  const YamlReader of = node.at("of");
  const LabelMode kind = one_of(of, words(LabelMode{}));
  if (kind == LabelMode::kNone || kind == LabelMode::kRecorded)
    of.fail(fmt::format("'{}' labels have no dials", name(kind)));
  const std::string called = own_name(node, node.string("name"));
  LabelNoiseConfig dials{.enabled = true};
  MappingReader read(node);
  fields(dials, read);
  node.finish();
  return {kind, dials, called};
}

}  // namespace

Labels read_label_source(YamlReader node, const std::filesystem::path& folder) {
  if (!node.is_map()) return one_of(node, words(LabelMode{}));
  if (node.find("of")) return read_dose(node);
  DetectorSpec spec;
  read_detector(node, folder, spec);
  const std::string called = own_name(node, node.string("name", source_of(spec).stem().string()));
  node.finish();
  return {std::move(spec), called};
}

SensorConfig with_dials(SensorConfig level, const Labels& labels) {
  if (labels.dials) level.labels.noise = *labels.dials;
  return level;
}

const std::filesystem::path& source_of(const DetectorSpec& spec) {
  return spec.network.empty() ? spec.boxes : spec.network;
}

}  // namespace mh
