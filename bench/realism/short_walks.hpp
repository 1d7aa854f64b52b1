// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// Moments of somebody who walks through the scene with a camera: each a few poses at 30 Hz, the
/// middle one at index kMiddlePose. Places are drawn from the free part of the rooms (0.3 m from
/// every object's box), 1.1 to 1.6 m high; the camera looks anywhere, up to 30 degrees down and 12
/// up, and moves at speeds of 7-Scenes' redkitchen (0.03 to 0.42 m/s, 2 to 26 deg/s).
/// @throws InputError if the scene has no room, or none with a free place
std::vector<Trajectory> short_walks(const Scene& scene, std::uint64_t seed, std::size_t count);
inline constexpr std::size_t kMiddlePose = 3;

}  // namespace mh
