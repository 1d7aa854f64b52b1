// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/mesh_io/gltf/primitives.hpp"

namespace mh::gltf {

/// Replaces the percent codes of URIs (my%20image.png), unless a file is named with them.
void decode_uris(Json& gltf, const std::filesystem::path& folder);

/// Gives textures whose image only an extension names (EXT_texture_webp, KHR_texture_basisu and the
/// like) that image, whether or not it can be decoded.
void choose_images(Json& gltf);

/// Writes what extensions state about color and emission as plain materials:
/// KHR_materials_pbrSpecularGlossiness and KHR_materials_emissive_strength.
void mend_materials(Json& gltf);

/// Removes the texture placement from each material. @returns that of the base color or, without
/// one, that of the emission.
/// @param warnings a line for each material whose two textures are placed differently
/// @throws InputError naming the material: not a transform
std::vector<UvPlacement> take_uv_placements(Json& gltf, const std::filesystem::path& file,
                                            std::vector<std::string>& warnings);

}  // namespace mh::gltf
