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
  std::vector<SharedGrid<Rgb8>> glow;  ///< by material: texture that multiplies its emission, or
                                       ///< empty
  /// For each material, how its texture continues beyond the left and right edges, and beyond the
  /// upper and lower edges: "clamped" or "mirrored"; null = it repeats.
  std::vector<std::array<const char*, 2>> edges;
};

/// Adds a line for each material whose texture is used beyond an edge where it should not repeat,
/// since all textures repeat here.
void warn_of_edges(const Scene& scene, const std::vector<std::array<const char*, 2>>& edges,
                   const std::filesystem::path& file, std::vector<std::string>& warnings);

/// Converts the materials of a file that assimp has read, in the same order.
/// @param file           its folder is searched for textures; warnings name it.
/// @param linear_colors  whether the file's colors are linear (glTF) or sRGB.
/// @param images       decodes and caches the textures
/// @param warnings       one line for every missing texture; may be null.
MaterialsIn convert_materials(const aiScene& in, const std::filesystem::path& file,
                              bool linear_colors, ImageStore& images,
                              std::vector<std::string>* warnings);

}  // namespace mh
