// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// Reads a Gazebo world or model (SDF), through libsdformat: what its visuals show, which are mesh
/// files, boxes, capsules, cylinders, ellipsoids, planes and spheres, with their colors and
/// textures (PBR's albedo maps, Ogre scripts). Each top-level model is an object; its class, and
/// that of a mesh's parts where the model's own name tells none, comes from labels.yaml beside the
/// world or from names (see LabelRules and load_mesh).
///
/// URIs are seen from the file that names them (gazebo::Finder), never from the current folder.
/// @param warnings  where to append what was left out or mended, once for each thing: models and
/// meshes that are not there, other shapes, missing textures; may be null
/// @throws InputError naming file and place: damaged SDF, poses that are none, includes that lead
/// back to themselves, nothing to be seen.
Scene load_gazebo_world(const std::filesystem::path& file,
                        std::vector<std::string>* warnings = nullptr);

}  // namespace mh
