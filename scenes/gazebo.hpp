// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// Reads a Gazebo world or model (SDF), through libsdformat: what its visuals show, which are mesh
/// files, boxes, cylinders, spheres and planes. Each top-level model is an object; its class, and
/// that of a mesh's parts where the model's own name tells none, comes from labels.yaml beside the
/// world or from names (see LabelRules and load_mesh).
///
/// model://NAME/... and package://NAME/... are looked for in the folder of the file that names
/// them, in the four above it, in each's models/, and in the folders of GAZEBO_MODEL_PATH,
/// GZ_SIM_RESOURCE_PATH and SDF_PATH.
/// @param warnings  where to append what could be mended: other shapes, missing textures; may be
/// null
/// @throws InputError naming file and place: damaged SDF, a mesh or an include that is not there,
/// includes that lead back to themselves.
Scene load_gazebo_world(const std::filesystem::path& file,
                        std::vector<std::string>* warnings = nullptr);

}  // namespace mh
