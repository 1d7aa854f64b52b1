// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// Reads a Gazebo world or model (SDF), through libsdformat: the geometry of its visuals, which are
/// mesh files, boxes, capsules, cylinders, ellipsoids, planes and spheres, with their colors and
/// textures (PBR's albedo maps, Ogre scripts). Each top-level model is an object; its class comes
/// from labels.yaml next to the world or from names (see LabelRules and load_mesh). If the model's
/// own name implies no class, the parts of a mesh get classes from their own names in the same
/// manner.
///
/// URIs are resolved relative to the file that contains them (gazebo::Finder), never to the current
/// folder.
/// @param warnings  where to append what was omitted or repaired, each item once: missing models
///                  and meshes, unsupported shapes, missing textures; may be null
/// @throws InputError naming file and place: malformed SDF, invalid poses, recursive includes,
/// nothing visible.
Scene load_gazebo_world(const std::filesystem::path& file,
                        std::vector<std::string>* warnings = nullptr);

}  // namespace mh
