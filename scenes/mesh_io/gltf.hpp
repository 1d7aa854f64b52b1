// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace mh {

/// A glTF file (text or binary) without invisible content that assimp cannot handle: animations,
/// and skins, whose meshes stay in their modeled pose. nullopt: nothing to remove, or not glTF,
/// which assimp will report.
/// @throws InputError naming the file if an offset into its buffers is beyond every buffer:
/// assimp's sums of such numbers overflow.
std::optional<std::string> repaired_gltf(std::string_view bytes, const std::filesystem::path& file);

}  // namespace mh
