// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace mh {

/// A glTF file (text or binary) without what is not shown and what assimp stumbles over:
/// animations, and skins, whose meshes stay as they were modeled. nullopt: it has none, or is no
/// glTF, which assimp shall say.
/// @throws InputError naming the file if a place in its buffers is beyond any buffer: assimp adds
/// such numbers up until they are small again.
std::optional<std::string> repaired_gltf(std::string_view bytes, const std::filesystem::path& file);

}  // namespace mh
