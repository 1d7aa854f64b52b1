// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scenes/scene.hpp"

namespace mh {

/// room.ply -> room.labels.json
std::filesystem::path labels_path(const std::filesystem::path& mesh);

/// Whether a file identifies itself as one written by save_labels().
bool is_labels_file(const std::filesystem::path& file);

/// Writes class and instance per face, the instances and the rooms; see save_scannet_ply.
void save_labels(const Scene& scene, const std::filesystem::path& file);

/// Sets name, class_of, instance_of, instances and rooms of a scene that already has its geometry.
/// @throws InputError if the file is damaged or belongs to another mesh.
void load_labels(Scene& scene, const std::filesystem::path& file);

}  // namespace mh
