// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// A synthetic room for training visual vocabularies only: plain solids (boxes, cylinders, racks,
/// slabs, panels) covered with training_patterns(), which no evaluation uses. Lamps are placed, but
/// light is not baked. Each seed gives a different room, reproducible bit for bit. The name is
/// "training_room_<seed>".
Scene make_training_room(std::uint64_t seed);

/// Camera poses (world_from_camera) in a training room: 0.8 to 1.6 m above the floor, at least 0.3
/// m from walls and objects' boxes, looking roughly level and not straight at a near wall.
/// @throws InputError if the scene has no room or no place is free.
std::vector<SE3> training_views(const Scene& scene, std::uint64_t seed, int count);

}  // namespace mh
