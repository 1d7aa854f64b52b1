// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "scenes/scene_frame.hpp"

namespace mh {

/// Loads a scene of any kind by the ending of its file: .yaml is a house (load_house) or, where it
/// lists objects, a scene of mesh files (load_placed_scene); .ply .obj .glb .gltf .dae are meshes
/// (load_mesh), .sdf .world are Gazebo's (load_gazebo_world). A folder is a ScanNet scene
/// (load_scannet), "generated:CATEGORY:SEED" is made by code (generate_scene).
///
/// Files of others get a floor (find_floor), and a room where they have none: the box around it.
/// @param warnings  where to append what could be mended; may be null.
/// @param frame     what the user tells of the file's frame
/// @throws InputError if the file is missing, damaged or of another ending, or `frame` turns a
/// house.
Scene load_scene(const std::filesystem::path& file, std::vector<std::string>* warnings = nullptr,
                 const SceneFrame& frame = {});

}  // namespace mh
