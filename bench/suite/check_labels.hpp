// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/scene.hpp"
#include "sim/sensors/labels.hpp"

namespace mh {

/// Checks that a scene has objects to draw boxes around if the labels are boxes, exact or a
/// detector's.
/// @returns a warning if it has objects, but none of a class that a detector knows (COCO's);
/// otherwise an empty string
/// @throws InputError if it has no objects, so that everything would be background.
std::string check_labels(const Scene& scene, LabelMode labels);

}  // namespace mh
