// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace mh {

/// KHR_materials_emissive_strength of the materials of a .gltf or .glb, which assimp drops; 1 if a
/// material has none. In assimp's order: the order of first use in the scene, a node's children
/// before its mesh. Names cannot identify them: several materials may share one.
/// @returns empty if the file uses no such strengths
std::vector<float> emissive_strengths(const std::filesystem::path& file);

}  // namespace mh
