// SPDX-License-Identifier: Apache-2.0
#include "scenes/thin_images.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "scenes/srgb.hpp"

namespace mh {
namespace {

constexpr double kCoarsest_m = 0.0012;
constexpr int kMostHalvings = 6;

/// Area of the surface that shows an image, by how often the image could be halved there.
using AreaByHalvings = std::array<double, kMostHalvings + 1>;

std::map<const void*, AreaByHalvings> measure(const Scene& scene) {
  std::map<const void*, AreaByHalvings> areas;  // never iterated: pointers have no order
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    const SharedGrid<Rgb8>& image = scene.materials[scene.material_of[face]].texture;
    if (image.empty()) continue;
    const auto& [a, b, c] = scene.triangles[face];
    const auto& at = scene.positions_m;
    const auto& uv = scene.uvs;
    const double area_m2 = 0.5 * (at[b] - at[a]).cross(at[c] - at[a]).cast<double>().norm();
    const Eigen::Vector2d step1 = (uv[b] - uv[a]).cast<double>(),
                          step2 = (uv[c] - uv[a]).cast<double>();
    const double texels = 0.5 * std::abs(step1.x() * step2.y() - step2.x() * step1.y()) *
                          static_cast<double>(image.size());
    constexpr double kFew = 4.0;  // with fewer, a face takes its color from a single point
    if (texels < kFew || area_m2 <= 0.0) continue;
    const double halvings = std::floor(std::log2(kCoarsest_m / std::sqrt(area_m2 / texels)));
    const auto [place, is_new] = areas.try_emplace(image.identity(), AreaByHalvings{});
    place->second[static_cast<std::size_t>(std::clamp(halvings, 0.0, 1.0 * kMostHalvings))] +=
        area_m2;
  }
  return areas;
}

int halvings_of(const AreaByHalvings& areas) {
  double whole = 0.0, from_above = 0.0;
  for (const double area : areas) whole += area;
  constexpr double kShare = 0.95;
  for (int halvings = kMostHalvings; halvings > 0; --halvings) {
    from_above += areas[static_cast<std::size_t>(halvings)];
    if (from_above >= kShare * whole) return halvings;
  }
  return 0;
}

/// Averages areas of the image in linear light.
Grid2d<Rgb8> shrunk(const Grid2d<Rgb8>& image, int halvings) {
  const int width = std::max(1, image.width() >> halvings);
  const int height = std::max(1, image.height() >> halvings);
  std::array<float, 256> linear;
  for (int level = 0; level < 256; ++level)
    linear[static_cast<std::size_t>(level)] = linear_from_srgb(static_cast<std::uint8_t>(level));
  Grid2d<Rgb8> small(width, height);
  const auto begin = [](int at, int few, int many) {
    return static_cast<int>(static_cast<std::int64_t>(at) * many / few);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int x0 = begin(x, width, image.width()), x1 = begin(x + 1, width, image.width());
      const int y0 = begin(y, height, image.height()), y1 = begin(y + 1, height, image.height());
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int from_y = y0; from_y < y1; ++from_y)
        for (int from_x = x0; from_x < x1; ++from_x) {
          const Rgb8 texel = image(from_x, from_y);
          sum += Eigen::Vector3f(linear[texel.r], linear[texel.g], linear[texel.b]);
        }
      small(x, y) = srgb_from_linear((sum / static_cast<float>((x1 - x0) * (y1 - y0))).eval());
    }
  return small;
}

}  // namespace

void thin_images(Scene& scene) {
  if (scene.uvs.empty()) return;
  std::map<const void*, AreaByHalvings> areas = measure(scene);
  std::map<const void*, SharedGrid<Rgb8>> thinned;
  for (Material& material : scene.materials) {
    const auto found = areas.find(material.texture.identity());
    if (found == areas.end() || !material.opacity.empty()) continue;
    const int halvings = halvings_of(found->second);
    if (halvings == 0) continue;
    const auto [place, is_new] = thinned.try_emplace(found->first);
    if (is_new) place->second = shrunk(material.texture, halvings);
    material.texture = place->second;
  }
}

}  // namespace mh
