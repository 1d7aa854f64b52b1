// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/mesh_io/image_in.hpp"
#include "scenes/scene.hpp"

struct aiScene;

namespace mh {

struct MaterialsIn {
  std::vector<Material> materials;
  std::vector<SharedGrid<Rgb8>> glow;  ///< for each, the texture that multiplies its emission; or
                                       ///< empty
  /// For each, how its texture continues beyond its left and right edge, and the upper and lower:
  /// "clamped", "mirrored"; null = it repeats.
  std::vector<std::array<const char*, 2>> edges;
};

/// A line for each material whose texture is used beyond an edge where it does not repeat: here all
/// textures do.
void warn_of_edges(const Scene& scene, const std::vector<std::array<const char*, 2>>& edges,
                   const std::filesystem::path& file, std::vector<std::string>& warnings);

/// Converts the materials of a file that assimp has read, one to one.
/// @param file           its folder is searched for textures; warnings name it.
/// @param linear_colors  whether the file's colors are linear (glTF) or sRGB.
/// @param images       decodes and caches the textures
/// @param warnings       one line for every texture that is missing; may be null.
MaterialsIn convert_materials(const aiScene& in, const std::filesystem::path& file,
                              bool linear_colors, ImageStore& images,
                              std::vector<std::string>* warnings);

}  // namespace mh
