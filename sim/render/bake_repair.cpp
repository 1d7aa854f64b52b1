// SPDX-License-Identifier: Apache-2.0
#include "sim/render/bake_repair.hpp"

#include "sim/render/color.hpp"

namespace mh {
namespace {

using Eigen::Vector3f;

// Light is averaged only between vertices whose normals differ by less than 25 deg, with weights
// that fall once their light differs by more than kNoise, the relative size of the noise, so that
// contact shadows are preserved.
constexpr float kSameSurface = 0.9F;
constexpr float kNoise = 0.1F;

/// Gives unknown vertices the mean of their known neighbors, ring by ring from the border inward.
void fill(std::vector<char>& known, const BakeSurface& surface, Colors& direct, Colors& indirect) {
  constexpr int kRings = 16;  // furniture is rarely wider than this many cells
  for (int ring = 0; ring < kRings; ++ring) {
    std::vector<std::size_t> filled;
    for (std::size_t v = 0; v < known.size(); ++v) {
      if (known[v]) continue;
      Vector3f sum_direct = Vector3f::Zero(), sum_indirect = Vector3f::Zero();
      float weight = 0.0F;
      for (const std::uint32_t n : surface.neighbors.of(v)) {
        if (!known[n] || surface.points.normal(n).dot(surface.points.normal(v)) < kSameSurface)
          continue;
        sum_direct += direct[n];
        sum_indirect += indirect[n];
        weight += 1.0F;
      }
      if (weight <= 0.0F) continue;
      direct[v] = sum_direct / weight;
      indirect[v] = sum_indirect / weight;
      filled.push_back(v);
    }
    if (filled.empty()) return;
    for (const std::size_t v : filled) known[v] = 1;
  }
}

}  // namespace

void repair(const std::vector<char>& inside, const BakeSurface& surface, int smoothing,
            Colors& direct, Colors& indirect) {
  std::vector<char> known(inside.size());
  for (std::size_t v = 0; v < known.size(); ++v) known[v] = !inside[v];
  fill(known, surface, direct, indirect);
  for (int round = 0; round < smoothing; ++round) {
    const Colors before = indirect;
    for (std::size_t v = 0; v < before.size(); ++v) {
      const float own = luminance(before[v]);
      Vector3f sum = before[v];
      float weight = 1.0F;
      for (const std::uint32_t n : surface.neighbors.of(v)) {
        if (!known[n] || surface.points.normal(n).dot(surface.points.normal(v)) < kSameSurface)
          continue;
        const float step = (luminance(before[n]) - own) / (kNoise * own + 1e-6F);
        const float w = 1.0F / (1.0F + step * step);
        sum += w * before[n];
        weight += w;
      }
      indirect[v] = sum / weight;
    }
  }
}

}  // namespace mh
