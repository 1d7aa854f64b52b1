// SPDX-License-Identifier: Apache-2.0
#include "sim/render/face_record.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "sim/render/color.hpp"

namespace mh {
namespace {

using Eigen::Vector3f;

template <std::size_t N>
void store_halves(std::array<std::uint16_t, N>& out, const Vector3f& value) {
  const __m128i halves =
      _mm_cvtps_ph(_mm_setr_ps(value.x(), value.y(), value.z(), 0.0F), _MM_FROUND_TO_NEAREST_INT);
  std::memcpy(out.data(), &halves, N * sizeof(std::uint16_t));
}

/// What the faces of a material share.
struct Surface {
  std::uint32_t texture = TextureTable::kWhite;
  float texels = 0.0F;                   // number of texels of level 0
  Vector3f base = Vector3f::Ones();      // linear
  Vector3f emission = Vector3f::Zero();  // linear x exposure
};

/// Adds each texture once, however many materials use it; returns positions by identity.
std::map<const void*, std::uint32_t> add_textures(const Scene& scene, TextureTable& textures) {
  std::map<const void*, std::uint32_t> place_of;  // never iterated
  std::vector<const Grid2d<Rgb8>*> images;
  for (const Material& material : scene.materials)
    if (!material.texture.empty() && place_of.try_emplace(material.texture.identity()).second)
      images.push_back(&material.texture.grid());
  textures.reserve(images);
  for (const Grid2d<Rgb8>* image : images) place_of.at(image) = textures.add(*image);
  return place_of;
}

/// One surface per material, at least one. Without texture coordinates, textures are left out, and
/// their mean colors go into the faces' records.
std::vector<Surface> make_surfaces(const Scene& scene, float exposure, TextureTable& textures) {
  std::map<const void*, std::uint32_t> place_of;
  if (!scene.uvs.empty()) place_of = add_textures(scene, textures);
  std::vector<Surface> surfaces;
  for (const Material& material : scene.materials) {
    Surface& surface = surfaces.emplace_back();
    surface.base = srgb_to_linear(material.base_color);
    surface.emission = material.emission * exposure;
    if (material.texture.empty()) continue;
    if (scene.uvs.empty()) {
      surface.base = surface.base.cwiseProduct(mean_linear(material.texture));
    } else {
      surface.texture = place_of.at(material.texture.identity());
      surface.texels = static_cast<float>(material.texture.size());
    }
  }
  if (surfaces.empty()) surfaces.emplace_back();
  return surfaces;
}

FaceRecord make_record(const Scene& scene, const Surface& surface, std::size_t face,
                       float exposure) {
  FaceRecord record;
  record.class_id = scene.class_of[face];
  record.instance = scene.instance_of[face];
  store_halves(record.emission, surface.emission);
  const auto& corners = scene.triangles[face];
  std::array<Vector3f, 3> gain;
  for (std::size_t k = 0; k < 3; ++k) {
    gain[k] = surface.base * exposure;
    if (!scene.colors.empty())
      gain[k] = gain[k].cwiseProduct(srgb_to_linear(scene.colors[corners[k]]));
    if (!scene.light.empty()) gain[k] = gain[k].cwiseProduct(scene.light[corners[k]]);
  }
  store_halves(record.gain, gain[0]);
  store_halves(record.gain_step1, gain[1] - gain[0]);
  store_halves(record.gain_step2, gain[2] - gain[0]);
  return record;
}

FaceTexture make_texture(const Scene& scene, const Surface& surface, std::size_t face) {
  FaceTexture record;
  record.texture = surface.texture;
  if (surface.texture == TextureTable::kWhite) return record;
  const auto& corners = scene.triangles[face];
  const Eigen::Vector2f& first = scene.uvs[corners[0]];
  const Eigen::Vector2f at = first - first.array().floor().matrix();  // periodic: keeps it small
  const Eigen::Vector2f step1 = scene.uvs[corners[1]] - first;
  const Eigen::Vector2f step2 = scene.uvs[corners[2]] - first;
  record.u = at.x(), record.v = at.y();
  record.du1 = step1.x(), record.dv1 = step1.y();
  record.du2 = step2.x(), record.dv2 = step2.y();
  record.texels = std::abs(step1.x() * step2.y() - step2.x() * step1.y()) * surface.texels;
  return record;
}

}  // namespace

FaceRecords::FaceRecords(const Scene& scene, const std::vector<std::uint32_t>& order,
                         float exposure) {
  const std::vector<Surface> surfaces = make_surfaces(scene, exposure, textures_);
  const bool textured = std::any_of(surfaces.begin(), surfaces.end(), [](const Surface& surface) {
    return surface.texture != TextureTable::kWhite;
  });
  if (textured)
    textured_faces_.reserve(order.size() + 1);
  else
    plain_faces_.reserve(order.size() + 1);
  for (const std::uint32_t face : order) {
    const Surface& surface = surfaces[scene.materials.empty() ? 0 : scene.material_of[face]];
    const FaceRecord record = make_record(scene, surface, face, exposure);
    if (textured)
      textured_faces_.push_back({record, make_texture(scene, surface, face)});
    else
      plain_faces_.push_back(record);
  }
  Vector3f sky = Vector3f::Zero();
  for (const Light& light : scene.lights)
    if (light.kind == Light::Kind::kSky) sky += light.color * exposure;
  FaceRecord nothing;
  store_halves(nothing.emission, sky.cwiseMin(1.0F));
  if (textured)
    textured_faces_.push_back({nothing, {}});
  else
    plain_faces_.push_back(nothing);
}

}  // namespace mh
