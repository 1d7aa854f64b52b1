// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

struct aiScene;

namespace mh {

/// Converts the materials of a file that assimp has read, one to one.
/// @param file              where textures are looked for (its folder) and what warnings name.
/// @param linear_colours    whether the file's colours are linear (glTF) or sRGB.
/// @param warnings          one line for every texture that is missing; may be null.
std::vector<Material> convert_materials(const aiScene& in, const std::filesystem::path& file,
                                        bool linear_colours, std::vector<std::string>* warnings);

}  // namespace mh
