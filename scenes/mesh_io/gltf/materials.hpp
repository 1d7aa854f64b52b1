// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/mesh_io/gltf/primitives.hpp"

namespace mh::gltf {

/// Decodes the percent codes of URIs (my%20image.png), unless there is a file with the encoded
/// name.
void decode_uris(Json& gltf, const std::filesystem::path& folder);

/// Some textures name their image only in an extension (EXT_texture_webp, KHR_texture_basisu and
/// the like): gives them that image, whether or not it can be decoded.
void choose_images(Json& gltf);

/// Converts what extensions state about color and emission to plain materials:
/// KHR_materials_pbrSpecularGlossiness and KHR_materials_emissive_strength.
void repair_materials(Json& gltf);

/// Removes the texture placement from each material. @returns for each material, the placement of
/// its base color's texture or, if it has none, of its emission's texture
/// @param warnings a line for each material whose two textures are placed differently
/// @throws InputError naming the material if its placement is invalid
std::vector<UvPlacement> take_uv_placements(Json& gltf, const std::filesystem::path& file,
                                            std::vector<std::string>& warnings);

}  // namespace mh::gltf
