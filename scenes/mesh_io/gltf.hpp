// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// A glTF file as assimp can read it.
struct RepairedGltf {
  std::string bytes;
  std::filesystem::path decoded_name;  ///< names the file's additional buffer
  std::string decoded;                 ///< its content; empty if there is none
};

/// Prepares a glTF file (text or binary) for assimp: extensions, quantized, sparse and compressed
/// data, texture coordinates other than the first set, and percent codes in names become plain
/// glTF. Animations and skins, which are invisible, are removed: meshes stay in their modeled pose.
/// nullopt if there is nothing to change, or if it is not glTF, which assimp will report.
/// @param warnings  one line for each ignored extension that would change what is seen; may be null
/// @throws InputError naming the file: an unknown extension that it requires; an offset beyond the
/// end of every buffer (assimp's sums of such offsets overflow); damaged data
std::optional<RepairedGltf> repaired_gltf(std::string_view bytes, const std::filesystem::path& file,
                                          std::vector<std::string>* warnings = nullptr);

}  // namespace mh
