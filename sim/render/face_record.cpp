// SPDX-License-Identifier: Apache-2.0
#include "sim/render/face_record.hpp"

#include <cmath>
#include <cstring>

#include "sim/render/colour.hpp"

namespace mh {
namespace {

void store_halves(std::uint16_t* out, const Eigen::Vector3f& value) {
  const __m128i halves =
      _mm_cvtps_ph(_mm_setr_ps(value.x(), value.y(), value.z(), 0.0F), _MM_FROUND_TO_NEAREST_INT);
  std::memcpy(out, &halves, 4 * sizeof(std::uint16_t));
}

Eigen::Vector3f base_colour(const Scene& scene, std::uint16_t material) {
  const Eigen::Vector3f base = srgb_to_linear(scene.materials[material].base_colour);
  const bool by_mean = scene.uvs.empty() && !scene.materials[material].texture.empty();
  return by_mean
             ? Eigen::Vector3f(base.cwiseProduct(mean_linear(scene.materials[material].texture)))
             : base;
}

}  // namespace

std::vector<Surface> make_surfaces(const Scene& scene, float exposure) {
  std::vector<Surface> surfaces;
  for (const Material& material : scene.materials) {
    const Eigen::Vector3f e = material.emission * exposure;
    surfaces.push_back({scene.uvs.empty() ? MipTexture() : MipTexture(material.texture),
                        _mm_setr_ps(e.x(), e.y(), e.z(), 0.0F)});
  }
  if (surfaces.empty()) surfaces.push_back({MipTexture(), _mm_setzero_ps()});
  return surfaces;
}

std::vector<Eigen::Vector3f> base_colours(const Scene& scene) {
  std::vector<Eigen::Vector3f> colours;
  for (std::size_t m = 0; m < scene.materials.size(); ++m)
    colours.push_back(base_colour(scene, static_cast<std::uint16_t>(m)));
  if (colours.empty()) colours.push_back(Eigen::Vector3f::Ones());
  return colours;
}

FaceRecord make_record(const Scene& scene, const std::vector<Surface>& surfaces,
                       const std::vector<Eigen::Vector3f>& base, std::size_t face, float exposure) {
  FaceRecord record;
  record.class_id = scene.class_of[face];
  record.instance = scene.instance_of[face];
  record.surface = scene.materials.empty() ? std::uint16_t{0} : scene.material_of[face];
  const auto& corners = scene.triangles[face];
  for (std::size_t k = 0; k < 3; ++k) {
    Eigen::Vector3f gain = base[record.surface] * exposure;
    if (!scene.colours.empty()) gain = gain.cwiseProduct(srgb_to_linear(scene.colours[corners[k]]));
    if (!scene.light.empty()) gain = gain.cwiseProduct(scene.light[corners[k]]);
    store_halves(record.gain.data() + 4 * k, gain);
    if (scene.uvs.empty()) continue;
    record.uv[2 * k] = scene.uvs[corners[k]].x();
    record.uv[2 * k + 1] = scene.uvs[corners[k]].y();
  }
  const auto& t = record.uv;
  const MipTexture& texture = surfaces[record.surface].texture;
  record.texels = std::abs((t[2] - t[0]) * (t[5] - t[1]) - (t[4] - t[0]) * (t[3] - t[1])) *
                  static_cast<float>(texture.width()) * static_cast<float>(texture.height());
  return record;
}

}  // namespace mh
