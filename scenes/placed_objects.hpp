// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scenes/scene.hpp"
#include "scenes/scene_frame.hpp"

namespace mh {

/// Adds a part to a scene: its vertices moved, its objects renamed to "prefix/name" (a part of one
/// object becomes "prefix") and numbered on.
/// @param class_id  of the whole part, which then is one object named prefix; nullopt = as it says
/// @throws InputError if there are more than 65535 objects or materials.
void append_part(Scene& scene, Scene part, const Eigen::Affine3d& scene_from_part,
                 const std::string& prefix, std::optional<ClassId> class_id = std::nullopt);

/// What a scene that was put together still needs: boxes and rooms. @throws InputError if it is
/// empty or not sound.
void finish_parts(Scene& scene);

/// Whether a YAML file tells of placed objects (key `objects`) and not of a house.
bool is_placed_scene(const std::filesystem::path& yaml);

/// Reads a scene of mesh files, each put in its place: see PlacedScene.
/// @param warnings  where to append what could be mended; may be null
/// @param up        of files whose objects tell nothing else
/// @throws InputError "file:line: place: value".
Scene load_placed_scene(const std::filesystem::path& yaml,
                        std::vector<std::string>* warnings = nullptr,
                        std::optional<UpAxis> up = {});

/// What the YAML file tells of the frame of all its objects.
SceneFrame placed_frame(const std::filesystem::path& yaml);

}  // namespace mh
