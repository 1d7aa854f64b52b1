// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace mh {

/// KHR_materials_emissive_strength of the materials of a .gltf or .glb, which assimp drops; 1 where
/// a material has none. In assimp's order: as it comes to them from the scene, a node's children
/// before its mesh. Names do not tell them apart: several may have one.
/// @returns empty where the file uses no such strengths
std::vector<float> emissive_strengths(const std::filesystem::path& file);

}  // namespace mh
