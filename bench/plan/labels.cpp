// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/labels.hpp"

#include <fmt/format.h>

#include "bench/plan/names.hpp"

namespace mh {
namespace {

constexpr Names<LabelMode, 6> kLabels{{{"exact", LabelMode::kExact},
                                       {"annotated", LabelMode::kAnnotated},
                                       {"boxes", LabelMode::kBoxes},
                                       {"detector", LabelMode::kDetector},
                                       {"none", LabelMode::kNone},
                                       {"recorded", LabelMode::kRecorded}}};

}  // namespace

std::string_view name(LabelMode labels) {
  return name_of(labels, kLabels);
}

std::string name(const Labels& labels) {
  return labels.detector ? labels.called : std::string(name(labels.mode));
}

std::string with_labels(const Labels& labels) {
  if (labels.detector) return fmt::format("labels from {}", labels.called);
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

Labels read_label_source(YamlReader node, const std::filesystem::path& folder) {
  if (!node.is_map()) return one_of(node, kLabels);
  DetectorSpec spec;
  read_detector(node, folder, spec);
  const std::string called = node.string("name", source_of(spec).stem().string());
  node.finish();
  check_folder_name(node, called);
  if (value_of(called, kLabels))
    node.fail(fmt::format("'{}' is a kind of labels: name the detector by another", called));
  return {std::move(spec), called};
}

const std::filesystem::path& source_of(const DetectorSpec& spec) {
  return spec.network.empty() ? spec.boxes : spec.network;
}

}  // namespace mh
