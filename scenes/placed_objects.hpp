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

/// Adds a part to a scene: vertices transformed, objects renamed to "prefix/name" (if the part has
/// only one object, to "prefix") and renumbered.
/// @param class_id  class of the whole part, which then is one object named prefix; nullopt keeps
///                  the part's own objects and classes
/// @throws InputError if there are more than 65535 objects or materials.
void append_part(Scene& scene, Scene part, const Eigen::Affine3d& scene_from_part,
                 const std::string& prefix, std::optional<ClassId> class_id = std::nullopt);

/// Completes a scene that was put together from parts: boxes and rooms. @throws InputError if it is
/// empty or inconsistent.
void finish_parts(Scene& scene);

/// Whether a YAML file describes placed objects (key `objects`) and not a house.
bool is_placed_scene(const std::filesystem::path& yaml);

/// Reads a scene of mesh files, each at its pose: see PlacedScene.
/// @param warnings  where to append what was repaired; may be null
/// @param up        up axis of files whose objects do not state one
/// @throws InputError "file:line: place: value".
Scene load_placed_scene(const std::filesystem::path& yaml,
                        std::vector<std::string>* warnings = nullptr,
                        std::optional<UpAxis> up = {});

/// What the YAML file states about the frame of all its objects.
SceneFrame placed_frame(const std::filesystem::path& yaml);

}  // namespace mh
