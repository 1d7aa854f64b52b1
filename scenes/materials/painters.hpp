// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/materials/colour.hpp"
#include "scenes/materials/noise.hpp"

namespace mh {

/// What a painter is asked for: a texture of width x height texels, each texel_m wide.
struct PaintJob {
  int width = 0, height = 0;
  float texel_m = 0.002F;
  Tint tone;               ///< the surface's mean (or a picture's key) colour
  float variation = 0.5F;  ///< contrast of the pattern, 0 to 1
  RandomStream random;

  /// Texels that a length covers, at least one.
  int texels(double length_m) const {
    return std::max(1, static_cast<int>(length_m / texel_m + 0.5));
  }
};

using Picture = Grid2d<Rgb8>;
using Painter = Picture (*)(const PaintJob&);

// wood.cpp
Picture paint_wood_grain(const PaintJob& job);

}  // namespace mh
