// SPDX-License-Identifier: Apache-2.0
#pragma once

// Shared by the painters of training patterns; not for use elsewhere.

#include <algorithm>
#include <array>
#include <cstdint>

#include "scenes/materials/color.hpp"
#include "scenes/materials/noise.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/random.hpp"

namespace mh::training {

/// Side length of a sheet, texels.
constexpr int kTexels = 512;
using Sheet = Grid2d<Rgb8>;

/// Colors and randomness of one sheet.
struct Ink {
  RandomStream random;
  std::array<Tint, 5> palette;

  explicit Ink(RandomStream stream) : random(stream) {
    const RandomStream colors = stream.fork(1000);
    for (std::uint64_t i = 0; i < palette.size(); ++i) {
      // Light and dark alternate, so that neighbors in the palette are distinguishable.
      const bool is_light = (i + colors.below(90, 2)) % 2 == 0;
      const double low = is_light ? 130.0 : 40.0, high = is_light ? 235.0 : 140.0;
      const auto base = static_cast<float>(colors.uniform(4 * i, low, high));
      const auto channel = [&](std::uint64_t k) {
        return base * static_cast<float>(colors.uniform(4 * i + k, 0.75, 1.15));
      };
      palette[i] = {channel(1), channel(2), channel(3)};
    }
  }
  float uniform(std::uint64_t i, double low, double high) const {
    return static_cast<float>(random.uniform(i, low, high));
  }
  int whole(std::uint64_t i, int low, int high) const {  ///< both ends included
    return low + static_cast<int>(random.below(i, static_cast<std::uint64_t>(high - low + 1)));
  }
  const Tint& pick(std::uint64_t i) const {
    return palette[random.fork(7).below(i, palette.size())];
  }
};

/// A sheet whose texel (x, y) is tint_at(x, y).
template <class TintAt>
Sheet fill(const TintAt& tint_at) {
  Sheet sheet(kTexels, kTexels);
  for (int y = 0; y < kTexels; ++y)
    for (int x = 0; x < kTexels; ++x) sheet(x, y) = to_rgb8(tint_at(x, y));
  return sheet;
}

/// Smooth noise in about [-1, 1], with `cells` blobs across the sheet.
inline Field clouds(const Ink& ink, std::uint64_t name, int cells, int octaves = 5,
                    float gain = 0.55F) {
  return fbm(kTexels, kTexels, {cells, cells, octaves, gain}, ink.random.fork(name));
}

}  // namespace mh::training
