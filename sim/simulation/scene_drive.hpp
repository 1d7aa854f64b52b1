// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "scenes/scene_frame.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// What is needed to render a scene along a drive.
struct SceneDrive {
  std::filesystem::path scene, tour, robot;
  std::filesystem::path level;  ///< sensor level; empty = no noise
  std::uint64_t seed = 0;       ///< determines which frames are delivered
  SceneFrame frame = {};
  std::function<void(Scene&)> light = {};  ///< adds the scene's light; empty: it is baked
};

/// Opens a scene seen by a robot along a tour, with exact labels, rendered on demand.
/// @param notes  receives one line for each repair of the scene; may be null
/// @throws InputError naming file and place.
std::unique_ptr<Sequence> open_scene(const SceneDrive& source,
                                     std::vector<std::string>* notes = nullptr);

}  // namespace mh
