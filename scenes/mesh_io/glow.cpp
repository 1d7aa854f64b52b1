// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/glow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "scenes/mesh_io/seen_colors.hpp"

namespace mh {
namespace {

using Share = std::array<std::uint8_t, 3>;  // share of the emission, in steps of 1 / kSteps
constexpr float kSteps = 31.0F;

/// The mean of a texture over a face, from samples about a texel apart, at most 32 along an edge.
Share share_of(const Scene& scene, std::size_t face, const Grid2d<Rgb8>& texture) {
  const auto& corners = scene.triangles[face];
  const Eigen::Vector2f first = scene.uvs[corners[0]];
  const Eigen::Vector2f step1 = scene.uvs[corners[1]] - first,
                        step2 = scene.uvs[corners[2]] - first;
  const Eigen::Vector2f size(static_cast<float>(texture.width()),
                             static_cast<float>(texture.height()));
  constexpr float kMost = 32.0F;
  const float longest = std::max(step1.cwiseProduct(size).norm(), step2.cwiseProduct(size).norm());
  const int count = static_cast<int>(std::clamp(std::ceil(longest), 1.0F, kMost));
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int i = 0; i < count; ++i)
    for (int j = 0; i + j < count; ++j) {
      // Centers of the small triangles along the first edge.
      const float a = (static_cast<float>(i) + 1.0F / 3.0F) / static_cast<float>(count);
      const float b = (static_cast<float>(j) + 1.0F / 3.0F) / static_cast<float>(count);
      sum += sample_texture(texture, first + a * step1 + b * step2);
    }
  const Eigen::Vector3f mean = sum / (0.5F * static_cast<float>(count * (count + 1)));
  Share share;
  for (std::size_t k = 0; k < share.size(); ++k)
    share[k] = static_cast<std::uint8_t>(
        std::lround(kSteps * std::clamp(mean[static_cast<Eigen::Index>(k)], 0.0F, 1.0F)));
  return share;
}

}  // namespace

void spread_glow(Scene& scene, const std::vector<SharedGrid<Rgb8>>& glow) {
  std::map<std::pair<std::uint16_t, Share>, std::uint16_t> material_of_share;
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    const std::uint16_t id = scene.material_of[face];
    if (id >= glow.size() || glow[id].empty() || scene.uvs.empty()) continue;
    const Share share = share_of(scene, face, glow[id]);
    const auto [place, is_new] = material_of_share.try_emplace({id, share}, id);
    constexpr std::size_t kMost = std::numeric_limits<std::uint16_t>::max();
    if (is_new && scene.materials.size() < kMost) {
      place->second = static_cast<std::uint16_t>(scene.materials.size());
      Material part = scene.materials[id];
      for (int k = 0; k < 3; ++k)
        part.emission[k] *= static_cast<float>(share[static_cast<std::size_t>(k)]) / kSteps;
      scene.materials.push_back(std::move(part));
    }
    scene.material_of[face] = place->second;
  }
}

}  // namespace mh
