// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/gltf/materials.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/mesh_io/percent.hpp"
#include "slam/io/error.hpp"

namespace mh::gltf {
namespace {

/// Removes an extension from an item and returns it; null if the item does not have it.
Json take_extension(Json& item, const char* name) {
  const Json::json_pointer place(std::string("/extensions/") + name);
  if (!item.is_object() || !item.contains(place)) return nullptr;
  Json taken = std::move(item[place]);
  item["extensions"].erase(name);
  return taken;
}

void replace_specular(Json& material) {
  const Json old = take_extension(material, "KHR_materials_pbrSpecularGlossiness");
  if (!old.is_object()) return;
  Json& surface = material["pbrMetallicRoughness"];
  surface["baseColorFactor"] = old.value("diffuseFactor", Json{1.0, 1.0, 1.0, 1.0});
  surface.erase("baseColorTexture");
  if (old.contains("diffuseTexture")) surface["baseColorTexture"] = old["diffuseTexture"];
}

void multiply_emission(Json& material) {
  const Json strength = take_extension(material, "KHR_materials_emissive_strength");
  if (!strength.is_object() || !strength.contains("emissiveStrength")) return;
  constexpr float kMost = 1e6F;
  const float by = std::clamp(strength["emissiveStrength"].get<float>(), 0.0F, kMost);
  for (Json& factor : list_of(material, "emissiveFactor"))
    if (factor.is_number()) factor = factor.get<float>() * by;
}

std::array<float, 2> pair_in(const Json& transform, const char* name,
                             const std::array<float, 2>& otherwise) {
  if (!transform.contains(name)) return otherwise;
  return {transform[name].at(0).get<float>(), transform[name].at(1).get<float>()};
}

/// With u to the right and v downward, `rotation` turns from v to u.
UvPlacement placement_of(const Json& texture, const Json& transform) {
  UvPlacement placement{.set = index_in(texture, "texCoord", 0)};
  if (!transform.is_object()) return placement;
  placement.set = index_in(transform, "texCoord", placement.set);
  const auto [u, v] = pair_in(transform, "offset", {0, 0});
  const auto [su, sv] = pair_in(transform, "scale", {1, 1});
  const float angle = transform.value("rotation", 0.0F);
  const float c = std::cos(angle), s = std::sin(angle);
  placement.rows = {c * su, s * sv, u, -s * su, c * sv, v};
  return placement;
}

UvPlacement take_placement(Json& texture) {
  const Json transform = take_extension(texture, "KHR_texture_transform");
  UvPlacement placement = placement_of(texture, transform);
  texture.erase("texCoord");
  return placement;
}

UvPlacement take_placement_of(Json& material, std::size_t index,
                              std::vector<std::string>& warnings) {
  const Json::json_pointer base("/pbrMetallicRoughness/baseColorTexture");
  const bool has_base = material.contains(base), glows = material.contains("emissiveTexture");
  const UvPlacement emission = glows ? take_placement(material["emissiveTexture"]) : UvPlacement();
  if (!has_base) return emission;
  const UvPlacement placement = take_placement(material[base]);
  const auto is_positive = [](const Json& factor) { return factor > 0.0; };
  if (glows && emission != placement &&
      std::ranges::any_of(list_of(material, "emissiveFactor"), is_positive))
    warnings.push_back(
        fmt::format("materials[{}]: its emissive texture is placed differently from its base "
                    "color: it is drawn where the base color is",
                    index));
  return placement;
}

void drop_name(Json& gltf, const char* list, const char* name) {
  const auto found = gltf.find(list);
  if (found == gltf.end() || !found->is_array()) return;
  auto& names = found->get_ref<Json::array_t&>();
  std::erase(names, name);
}

}  // namespace

void decode_uris(Json& gltf, const std::filesystem::path& folder) {
  for (const char* list : {"buffers", "images"})
    for (Json& item : list_of(gltf, list)) {
      if (!item.is_object() || !item.contains("uri") || !item["uri"].is_string()) continue;
      const auto& uri = item["uri"].get_ref<const std::string&>();
      if (!uri.starts_with("data:")) item["uri"] = named_by_uri(folder, uri);
    }
}

void choose_images(Json& gltf) {
  for (Json& texture : list_of(gltf, "textures")) {
    if (!texture.is_object() || texture.contains("source") || !texture.contains("extensions"))
      continue;
    for (const Json& extension : texture["extensions"])
      if (const std::size_t image = index_in(extension, "source", kNone); image != kNone)
        texture["source"] = image;
  }
}

void repair_materials(Json& gltf) {
  for (Json& material : list_of(gltf, "materials")) {
    replace_specular(material);
    multiply_emission(material);
  }
}

std::vector<UvPlacement> take_uv_placements(Json& gltf, const std::filesystem::path& file,
                                            std::vector<std::string>& warnings) {
  std::vector<UvPlacement> placements;
  const std::span<Json> materials = list_of(gltf, "materials");
  for (std::size_t i = 0; i < materials.size(); ++i) try {
      placements.push_back(take_placement_of(materials[i], i, warnings));
    } catch (const Json::exception&) {
      throw InputError(fmt::format("{}: materials[{}]: its KHR_texture_transform is not valid",
                                   file.string(), i));
    }
  drop_name(gltf, "extensionsUsed", "KHR_texture_transform");  // assimp would apply the rest
  return placements;
}

}  // namespace mh::gltf
