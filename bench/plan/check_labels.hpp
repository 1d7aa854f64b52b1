// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/scene.hpp"
#include "sim/sensors/labels.hpp"

namespace mh {

/// Whether boxes can be drawn in a scene, by a detector or exactly: that needs objects.
/// @returns a warning where it has some, but none of a class that a detector knows (COCO's); else
/// ""
/// @throws InputError where it has no objects, so that all would be background.
std::string check_labels(const Scene& scene, LabelMode labels);

}  // namespace mh
