// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// A made-up room for training visual vocabularies, and for nothing else: plain solids (boxes,
/// cylinders, racks, slabs, panels) clad in training_patterns(), which no evaluation uses. Lamps
/// are set, but light is not baked. Every seed is another room; one seed is one room, bit for bit.
/// The name is "training_room_<seed>".
Scene make_training_room(std::uint64_t seed);

/// Camera poses (world_from_camera) in such a room: 0.8 to 1.6 m above the floor, at least 0.3 m
/// from walls and objects' boxes, looking about level and not straight into a near wall.
/// @throws InputError if the scene has no room or no place is free.
std::vector<SE3> training_views(const Scene& scene, std::uint64_t seed, int count);

}  // namespace mh
