// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/gltf/extensions.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh::gltf {
namespace {

struct Extension {
  std::string_view name;
  std::string_view loss = {};  ///< visible difference from the file; empty = none
};

constexpr Extension kExtensions[] = {
    // Honored.
    {"EXT_mesh_gpu_instancing"},
    {"EXT_meshopt_compression"},
    {"KHR_draco_mesh_compression"},
    {"KHR_materials_emissive_strength"},
    {"KHR_materials_pbrSpecularGlossiness"},
    {"KHR_materials_transmission"},
    {"KHR_materials_unlit"},
    {"KHR_mesh_quantization"},
    {"KHR_meshopt_compression"},
    {"KHR_node_visibility"},
    {"KHR_texture_transform"},
    // Kinds of images: each image that cannot be decoded is named in a warning.
    {"EXT_texture_astc"},
    {"EXT_texture_avif"},
    {"EXT_texture_webp"},
    {"KHR_texture_basisu"},
    {"MSFT_texture_dds"},
    // Gloss and the interior of bodies, which are not modeled here.
    {"ADOBE_materials_clearcoat_specular"},
    {"ADOBE_materials_clearcoat_tint"},
    {"KHR_materials_anisotropy"},
    {"KHR_materials_clearcoat"},
    {"KHR_materials_diffuse_transmission"},
    {"KHR_materials_dispersion"},
    {"KHR_materials_ior"},
    {"KHR_materials_iridescence"},
    {"KHR_materials_sheen"},
    {"KHR_materials_specular"},
    {"KHR_materials_volume"},
    {"MSFT_packing_normalRoughnessMetallic"},
    {"MSFT_packing_occlusionRoughnessMetallic"},
    // Movement, sound, and choices that a viewer offers in addition to the initial view.
    {"KHR_animation_pointer"},
    {"KHR_audio"},
    {"KHR_audio_emitter"},
    {"KHR_interactivity"},
    {"KHR_materials_variants"},
    {"KHR_node_hoverability"},
    {"KHR_node_selectability"},
    {"MSFT_lod"},
    // Metadata about what is shown.
    {"AGI_articulations"},
    {"AGI_stk_metadata"},
    {"CESIUM_primitive_outline"},
    {"EXT_instance_features"},
    {"EXT_mesh_features"},
    {"EXT_mesh_manifold"},
    {"EXT_mesh_primitive_edge_visibility"},
    {"EXT_structural_metadata"},
    {"FB_geometry_metadata"},
    {"FB_ngon_encoding"},
    {"GODOT_single_root"},
    {"GRIFFEL_bim_data"},
    {"KHR_collision_shapes"},
    {"KHR_implicit_shapes"},
    {"KHR_physics_rigid_bodies"},
    {"KHR_rigid_bodies"},
    {"KHR_xmp"},
    {"KHR_xmp_json_ld"},
    // Visible, but not rendered here.
    {"EXT_lights_ies", "its lights are left out"},
    {"EXT_lights_image_based", "its light is left out"},
    {"EXT_mesh_primitive_restart", "faces next to a restart are left out"},
    {"KHR_gaussian_splatting", "splats are left out"},
    {"KHR_lights_punctual", "its lights are left out: surfaces have their full colors"},
    {"KHR_techniques_webgl", "what its shaders paint is left out"},
    {"MPEG_texture_video", "its videos are left out"},
    {"NV_materials_mdl", "its materials are left out"},
};

std::set<std::string> names_in(Json& gltf, const char* list) {
  std::set<std::string> names;
  for (const Json& name : list_of(gltf, list))
    if (name.is_string()) names.insert(name.get<std::string>());
  return names;
}

}  // namespace

void check_extensions(Json& gltf, const std::filesystem::path& file,
                      std::vector<std::string>& warnings) {
  const std::set<std::string> required = names_in(gltf, "extensionsRequired");
  std::set<std::string> listed = names_in(gltf, "extensionsUsed");
  listed.insert(required.begin(), required.end());
  for (const std::string& name : listed) {
    const auto* known = std::ranges::find(kExtensions, name, &Extension::name);
    const bool is_known = known != std::end(kExtensions);
    if (!is_known && required.contains(name))
      throw InputError(fmt::format(
          "{}: requires the glTF extension {}, which is not known: write the file without it",
          file.string(), name));
    if (is_known && known->loss.empty()) continue;
    warnings.push_back(fmt::format("glTF extension {}: {}", name,
                                   is_known ? known->loss : "is unknown and left out"));
  }
}

}  // namespace mh::gltf
