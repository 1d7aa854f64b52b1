// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/lens_dirt.hpp"

#include <algorithm>
#include <cmath>

#include "slam/core/random.hpp"

namespace mh {
namespace {

constexpr float kThroughSpot = 0.1F;
constexpr double kSmallest = 0.02, kLargest = 0.06;  // radii, as shares of the width
constexpr float kSoft = 0.5F;                        // share of a radius over which a spot fades

/// How much of a spot there is at a distance from its center: 1 inside, 0 outside.
float weight(float distance_px, float radius_px) {
  const float inside = (radius_px - distance_px) / (kSoft * radius_px) + 0.5F;
  return std::clamp(inside, 0.0F, 1.0F);
}

}  // namespace

Grid2d<float> light_through(const LensDirtConfig& config, int width_px, int height_px) {
  const RandomStream draws(config.lens);
  Grid2d<float> spots(width_px, height_px);  // 0 clear, 1 behind a spot
  std::size_t behind = 0;
  const auto wanted = static_cast<std::size_t>(config.share * static_cast<double>(spots.size()));
  for (std::uint64_t k = 0; behind < wanted; ++k) {
    const auto x0 = static_cast<float>(draws.uniform(3 * k) * width_px),
               y0 = static_cast<float>(draws.uniform(3 * k + 1) * height_px),
               radius = static_cast<float>(
                   (kSmallest + draws.uniform(3 * k + 2) * (kLargest - kSmallest)) * width_px);
    const float reach = (1 + kSoft / 2) * radius;  // nothing of the spot is beyond
    const int left = std::max(0, static_cast<int>(x0 - reach)),
              right = std::min(width_px, static_cast<int>(x0 + reach) + 2),
              top = std::max(0, static_cast<int>(y0 - reach)),
              bottom = std::min(height_px, static_cast<int>(y0 + reach) + 2);
    for (int y = top; y < bottom && behind < wanted; ++y)
      for (int x = left; x < right && behind < wanted; ++x) {
        const float w =
            weight(std::hypot(static_cast<float>(x) - x0, static_cast<float>(y) - y0), radius);
        float& spot = spots(x, y);
        if (w <= spot) continue;
        if (spot < 0.5F && w >= 0.5F) ++behind;
        spot = w;
      }
  }
  for (std::size_t i = 0; i < spots.size(); ++i)
    spots.data()[i] = 1.0F - (1.0F - kThroughSpot) * spots.data()[i];
  return spots;
}

}  // namespace mh
