// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/check_labels.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bench/suite/labels.hpp"
#include "sim/sensors/visible_objects.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh {

std::string check_labels(const Scene& scene, LabelMode labels) {
  if (labels != LabelMode::kBoxes && labels != LabelMode::kDetector) return "";
  if (std::ranges::all_of(scene.instance_of, [](InstanceId id) { return id == 0; }))
    throw InputError(
        fmt::format("{}: labels '{}' are boxes around objects, but its faces belong to none: all "
                    "would be background; use 'exact' or 'none'",
                    scene.name, name(labels)));
  const auto& of = scene.instances;
  if (std::ranges::any_of(of, [](const Instance& i) { return is_coco(i.class_id); })) return "";
  return fmt::format(
      "{}: none of its {} is of a class that a detector knows: labels '{}' are background "
      "everywhere",
      scene.name, counted(of.size(), "object"), name(labels));
}

}  // namespace mh
