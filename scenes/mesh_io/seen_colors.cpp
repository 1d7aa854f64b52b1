// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/seen_colors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "scenes/mesh_io/subdivide.hpp"
#include "scenes/srgb.hpp"

namespace mh {
namespace {

Rgb8 seen_color(const Scene& scene, std::uint32_t vertex, const Material& material) {
  Eigen::Array3f color = linear_from_srgb(material.base_color).array();
  if (!material.texture.empty())
    color *= sample_texture(material.texture, scene.uvs[vertex]).array();
  if (!scene.colors.empty()) color *= linear_from_srgb(scene.colors[vertex]).array();
  if (!scene.light.empty()) color *= scene.light[vertex].array();
  return srgb_from_linear((color + material.emission.array()).matrix().eval());
}

}  // namespace

Eigen::Vector3f sample_texture(const Grid2d<Rgb8>& texture, const Eigen::Vector2f& uv) {
  const float x = (uv.x() - std::floor(uv.x())) * static_cast<float>(texture.width()) - 0.5F;
  const float y = (uv.y() - std::floor(uv.y())) * static_cast<float>(texture.height()) - 0.5F;
  const float left = std::floor(x), top = std::floor(y);
  const auto wrap = [](float i, int n) { return (static_cast<int>(i) + n) % n; };
  const auto texel = [&](float i, float j) {
    return linear_from_srgb(texture(wrap(i, texture.width()), wrap(j, texture.height())));
  };
  const float tx = x - left, ty = y - top;
  return (1 - ty) * ((1 - tx) * texel(left, top) + tx * texel(left + 1, top)) +
         ty * ((1 - tx) * texel(left, top + 1) + tx * texel(left + 1, top + 1));
}

Scene split_for_colors(const Scene& scene, float max_edge_m) {
  const auto has_texture = [](const Material& material) { return !material.texture.empty(); };
  if (max_edge_m <= 0.0F ||
      (scene.light.empty() && std::ranges::none_of(scene.materials, has_texture)))
    return scene;
  return subdivide(scene, max_edge_m);
}

std::vector<Rgb8> seen_colors(const Scene& scene) {
  constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> material_of_vertex(scene.positions_m.size(), kUnused);
  for (std::size_t face = 0; face < scene.triangles.size(); ++face)
    for (const std::uint32_t vertex : scene.triangles[face])
      if (material_of_vertex[vertex] == kUnused)
        material_of_vertex[vertex] = scene.material_of[face];
  std::vector<Rgb8> colors(scene.positions_m.size());
  for (std::uint32_t v = 0; v < colors.size(); ++v)
    if (material_of_vertex[v] != kUnused)
      colors[v] = seen_color(scene, v, scene.materials[material_of_vertex[v]]);
  return colors;
}

}  // namespace mh
