// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Returns views (world_from_camera) of a person who scans the scene with a depth camera, up and
/// down and into all corners. Positions are drawn from the free space of the rooms (at least 0.3 m
/// from every object's box) at heights of 1.1 to 1.6 m. The camera looks in any direction, from 30
/// degrees down to 12 degrees up.
/// @throws InputError if the scene has no room, or none with free space
std::vector<SE3> scan_views(const Scene& scene, std::uint64_t seed, std::size_t count);

}  // namespace mh
