// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/scene.hpp"
#include "sim/physics/planar_world.hpp"

namespace mh {

/// " against NAME", or "" where the instance is none.
std::string against(const Scene& scene, InstanceId instance);

/// @param where  file and the like, for the message
/// @throws InputError if the base would stand inside something, or outside the rooms of a scene
/// that has rooms.
void check_start(PlanarWorld& world, const Scene& scene, const Eigen::Vector2d& start_m,
                 const std::string& where);

}  // namespace mh
