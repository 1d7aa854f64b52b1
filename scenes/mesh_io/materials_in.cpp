// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/materials_in.hpp"

#include <assimp/GltfMaterial.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/find_file.hpp"
#include "scenes/srgb.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

constexpr Rgb8 kMissing{255, 0, 255};  // conspicuous, and absent from real rooms

ImageIn convert_embedded(const aiTexture& texture, ImageStore& images) {
  if (texture.mHeight == 0)
    return images.decode({reinterpret_cast<const char*>(texture.pcData), texture.mWidth});
  const int width = static_cast<int>(texture.mWidth), height = static_cast<int>(texture.mHeight);
  Grid2d<Rgb8> color(width, height);
  Grid2d<std::uint8_t> opacity(width, height);
  for (std::size_t i = 0; i < color.size(); ++i) {
    const aiTexel& t = texture.pcData[i];
    color.data()[i] = {t.r, t.g, t.b};
    opacity.data()[i] = t.a;
  }
  return {.color = std::move(color), .opacity = std::move(opacity)};
}

/// Path of an image that a file in `folder` names: relative to that folder or, as in Gazebo, by its
/// bare name in the places where models keep their textures.
fs::path place_of_image(const fs::path& named, const fs::path& folder) {
  if (is_file(folder / named)) return folder / named;
  for (const fs::path& place :
       {named, fs::path(named.filename()), "../materials/textures" / named.filename(),
        "../textures" / named.filename(), "textures" / named.filename()})
    if (const auto found = find_any_case(folder / place)) return *found;
  return folder / named;
}

ImageIn find_texture(const aiScene& in, const std::string& name, const fs::path& folder,
                     ImageStore& images) {
  if (const aiTexture* embedded = in.GetEmbeddedTexture(name.c_str()))
    return convert_embedded(*embedded, images);
  std::string portable = name;
  std::ranges::replace(portable, '\\', '/');
  // MeshLab's PLYs have a space after the name.
  portable.erase(portable.find_last_not_of(" \t\r") + 1);
  if (portable.starts_with("file://")) portable.erase(0, std::strlen("file://"));
  return images.read(place_of_image(portable, folder));
}

Rgb8 convert_color(const aiColor4D& c, bool linear) {
  if (linear) return srgb_from_linear(Eigen::Vector3f(c.r, c.g, c.b));
  const auto level = [](float v) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(v, 0.0F, 1.0F)));
  };
  return {level(c.r), level(c.g), level(c.b)};
}

/// Whether a material's alpha is used. glTF states this explicitly; in other formats, alpha is used
/// wherever it is present.
bool has_holes(const aiMaterial& record) {
  aiString mode;
  return record.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != aiReturn_SUCCESS ||
         std::string_view(mode.C_Str()) != "OPAQUE";
}

/// A separate mask (OBJ's map_d) as opacity, resized to its texture.
Grid2d<std::uint8_t> opacity_of_mask(const ImageIn& mask, const Grid2d<Rgb8>& texture) {
  if (mask.color.empty() || texture.empty()) return {};
  Grid2d<std::uint8_t> opacity(texture.width(), texture.height());
  for (int y = 0; y < opacity.height(); ++y)
    for (int x = 0; x < opacity.width(); ++x) {
      const auto from_x = static_cast<int>(std::int64_t{x} * mask.color.width() / opacity.width());
      const auto from_y =
          static_cast<int>(std::int64_t{y} * mask.color.height() / opacity.height());
      opacity(x, y) =
          mask.opacity.empty() ? mask.color(from_x, from_y).g : mask.opacity(from_x, from_y);
    }
  return opacity;
}

/// Transmission of a material (linear RGB): glTF's KHR_materials_transmission, or the alpha of the
/// whole material if it is below kOpaqueFrom (in glTF, only with BLEND). Alpha 0 is more often a
/// mistake than an invisible object.
Eigen::Vector3f transmission_of(const aiMaterial& record, const aiColor4D& base) {
  const Eigen::Vector3f tint(base.r, base.g, base.b);
  float share = 0.0F;
  if (record.Get(AI_MATKEY_TRANSMISSION_FACTOR, share) == aiReturn_SUCCESS && share > 0.0F)
    return (std::min(share, 1.0F) * tint).cwiseMax(0.0F).cwiseMin(1.0F);
  float opacity = 1.0F;
  aiString mode;
  if (record.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS)
    opacity = std::string_view(mode.C_Str()) == "BLEND" ? base.a : 1.0F;
  else
    record.Get(AI_MATKEY_OPACITY, opacity);
  if (!(opacity > 0.0F && opacity < kOpaqueFrom / 255.0F)) return Eigen::Vector3f::Zero();
  return (Eigen::Vector3f::Constant(1.0F - opacity) + opacity * tint).cwiseMin(1.0F);
}

/// A file being read, and what its materials share.
struct Source {
  const aiScene& scene;
  const fs::path& file;
  bool linear;  ///< whether its colors are linear
  ImageStore& images;
  std::vector<std::string>* warnings;
};

Material convert(const Source& in, const aiMaterial& record, SharedGrid<Rgb8>& glow) {
  Material material;
  material.name = record.GetName().C_Str();
  aiColor4D base(1.0F, 1.0F, 1.0F, 1.0F);
  if (record.Get(AI_MATKEY_BASE_COLOR, base) == aiReturn_SUCCESS ||
      record.Get(AI_MATKEY_COLOR_DIFFUSE, base) == aiReturn_SUCCESS)
    material.base_color = convert_color(base, in.linear);
  aiColor3D emission;
  if (record.Get(AI_MATKEY_COLOR_EMISSIVE, emission) == aiReturn_SUCCESS)
    material.emission = {std::max(0.0F, emission.r), std::max(0.0F, emission.g),
                         std::max(0.0F, emission.b)};
  material.transmission = transmission_of(record, base);
  const auto find = [&](const aiString& name) {
    ImageIn image = find_texture(in.scene, name.C_Str(), in.file.parent_path(), in.images);
    if (image.color.empty() && in.warnings)
      in.warnings->push_back(fmt::format("{}: material {}: texture {} {}", in.file.string(),
                                         material.name, name.C_Str(), image.fault));
    return image;
  };
  aiString texture;
  if (!material.emission.isZero() &&
      record.GetTexture(aiTextureType_EMISSIVE, 0, &texture) == aiReturn_SUCCESS) {
    glow = find(texture).color;
    if (glow.empty()) material.emission.setZero();
  }
  if (record.GetTexture(aiTextureType_BASE_COLOR, 0, &texture) != aiReturn_SUCCESS &&
      record.GetTexture(aiTextureType_DIFFUSE, 0, &texture) != aiReturn_SUCCESS)
    return material;
  const ImageIn image = find(texture);
  if (image.color.empty()) material.base_color = kMissing;
  material.texture = image.color;
  aiString mask;
  if (record.GetTexture(aiTextureType_OPACITY, 0, &mask) == aiReturn_SUCCESS && mask != texture)
    material.opacity = opacity_of_mask(find(mask), material.texture);
  else if (has_holes(record))
    material.opacity = image.opacity;
  const auto opaque = [](std::uint8_t level) { return level >= kOpaqueFrom; };
  if (std::ranges::all_of(material.opacity, opaque)) material.opacity = {};
  return material;
}

const char* edge_of(const aiMaterial& record, const char* key) {
  int mode = aiTextureMapMode_Wrap;
  for (const aiTextureType kind : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE})
    if (record.Get(key, kind, 0, mode) == aiReturn_SUCCESS) break;
  return mode == aiTextureMapMode_Wrap     ? nullptr
         : mode == aiTextureMapMode_Mirror ? "mirrored"
                                           : "clamped";
}

std::array<const char*, 2> edges_of(const aiMaterial& record) {
  return {edge_of(record, _AI_MATKEY_MAPPINGMODE_U_BASE),
          edge_of(record, _AI_MATKEY_MAPPINGMODE_V_BASE)};
}

}  // namespace

void warn_of_edges(const Scene& scene, const std::vector<std::array<const char*, 2>>& edges,
                   const fs::path& file, std::vector<std::string>& warnings) {
  constexpr float kBeyond = 0.01F;  // tolerance: charts may reach a few texels beyond an edge
  std::vector<const char*> crossed(edges.size(), nullptr);
  for (std::size_t face = 0; face < scene.triangles.size() && !scene.uvs.empty(); ++face)
    for (const std::uint32_t vertex : scene.triangles[face])
      for (const int axis : {0, 1}) {
        const float at = scene.uvs[vertex][axis];
        const std::uint16_t material = scene.material_of[face];
        if (material < edges.size() && (at < -kBeyond || at > 1 + kBeyond) &&
            crossed[material] == nullptr)
          crossed[material] = edges[material][static_cast<std::size_t>(axis)];
      }
  for (std::size_t i = 0; i < crossed.size(); ++i)
    if (crossed[i] != nullptr && !scene.materials[i].texture.empty())
      warnings.push_back(
          fmt::format("{}: material {}: its texture is {} beyond the image's edges: it is repeated",
                      file.string(), scene.materials[i].name, crossed[i]));
}

MaterialsIn convert_materials(const aiScene& in, const fs::path& file, bool linear_colors,
                              ImageStore& images, std::vector<std::string>* warnings) {
  const Source source{in, file, linear_colors, images, warnings};
  MaterialsIn out;
  out.glow.resize(in.mNumMaterials);
  std::vector<Material>& materials = out.materials;
  for (unsigned i = 0; i < in.mNumMaterials; ++i)
    materials.push_back(convert(source, *in.mMaterials[i], out.glow[i]));
  for (unsigned i = 0; i < in.mNumMaterials; ++i) out.edges.push_back(edges_of(*in.mMaterials[i]));
  return out;
}

}  // namespace mh
