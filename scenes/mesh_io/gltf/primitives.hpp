// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scenes/mesh_io/gltf/data.hpp"

namespace mh::gltf {

/// How a material's texture is placed: the set of texture coordinates, and their transform
/// (KHR_texture_transform), row by row: u' = a u + b v + c, v' = d u + e v + f.
struct UvPlacement {
  std::size_t set = 0;
  std::array<float, 6> rows{1, 0, 0, 0, 1, 0};
  auto operator<=>(const UvPlacement&) const = default;
};

/// Gives every primitive data that assimp reads correctly: positions, colors and texture
/// coordinates as floats (KHR_mesh_quantization, sparse accessors, Draco), morph targets applied
/// with the weights of their mesh, and, as the first set of texture coordinates, the set that its
/// material uses.
/// @param placements  the placement for each material, see take_uv_placements
/// @param warnings    receives a line for each mesh that lacks the set of coordinates its material
/// uses
void repair_primitives(Json& gltf, Data& data, const std::vector<UvPlacement>& placements,
                       std::vector<std::string>& warnings);

}  // namespace mh::gltf
