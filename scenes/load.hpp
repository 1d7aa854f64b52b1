// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// Loads a scene of any kind by the ending of its file: .yaml is a house (load_house), .ply .obj
/// .glb .gltf .dae are meshes (load_mesh).
/// @param warnings where to append what could be mended; may be null.
/// @throws InputError if the file is missing, damaged or of another ending.
Scene load_scene(const std::filesystem::path& file, std::vector<std::string>* warnings = nullptr);

}  // namespace mh
