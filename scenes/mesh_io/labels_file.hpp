// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scenes/scene.hpp"

namespace mh {

/// room.ply -> room.labels.json
std::filesystem::path labels_path(const std::filesystem::path& mesh);

/// Whether a file says of itself that it is of the kind that save_labels() writes.
bool is_labels_file(const std::filesystem::path& file);

/// Writes class and instance per face, the instances and the rooms; see save_scannet_ply.
void save_labels(const Scene& scene, const std::filesystem::path& file);

/// Fills name, class_of, instance_of, instances and rooms of a scene whose geometry is there.
/// @throws InputError if the file is damaged or belongs to another mesh.
void load_labels(Scene& scene, const std::filesystem::path& file);

}  // namespace mh
