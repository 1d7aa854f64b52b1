// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "scenes/scene_frame.hpp"

namespace mh {

/// Loads a scene of any kind, by file extension: .yaml is a house (load_house) or, where it lists
/// objects, a scene of mesh files (load_placed_scene); .ply .obj .glb .gltf .dae .stl are meshes
/// (load_mesh), .sdf and .world are Gazebo worlds (load_gazebo_world). A folder is a ScanNet scene
/// (load_scannet), "generated:CATEGORY:SEED" is generated (generate_scene).
///
/// Scenes from other sources get a floor (find_floor) and, if they have no rooms, the floor's
/// bounding box as a room.
/// @param warnings  where to append what was repaired; may be null.
/// @param frame     what the user states about the file's frame
/// @throws InputError if the file is missing, damaged or of an unknown type, or `frame` states that
/// a house has y up.
Scene load_scene(const std::filesystem::path& file, std::vector<std::string>* warnings = nullptr,
                 const SceneFrame& frame = {});

}  // namespace mh
