// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/materials/color.hpp"
#include "scenes/materials/noise.hpp"

namespace mh {

/// Input of a painter: a texture of width x height texels, each texel_m wide.
struct PaintJob {
  int width = 0, height = 0;
  float texel_m = 0.002F;
  Tint tone;               ///< the surface's mean (or an image's key) color
  float variation = 0.5F;  ///< contrast of the pattern, 0 to 1
  RandomStream random;

  /// Number of texels in a length, at least one.
  int texels(double length_m) const {
    return std::max(1, static_cast<int>(length_m / texel_m + 0.5));
  }
};

using Picture = Grid2d<Rgb8>;
using Painter = Picture (*)(const PaintJob&);

/// The image whose texel (x, y) is tint_at(x, y).
template <class TintAt>
Picture paint(const PaintJob& job, const TintAt& tint_at) {
  Picture picture(job.width, job.height);
  for (int y = 0; y < job.height; ++y)
    for (int x = 0; x < job.width; ++x) picture(x, y) = to_rgb8(tint_at(x, y));
  return picture;
}

// wood.cpp: grain along u.
Picture paint_wood_grain(const PaintJob& job);
Picture paint_wood_boards(const PaintJob& job);
Picture paint_parquet(const PaintJob& job);
Picture paint_bark(const PaintJob& job);

// walls.cpp
Picture paint_plaster(const PaintJob& job);
Picture paint_ceiling(const PaintJob& job);
Picture paint_tiles(const PaintJob& job);
Picture paint_stone(const PaintJob& job);
Picture paint_brushed_metal(const PaintJob& job);
Picture paint_smooth(const PaintJob& job);  ///< ceramic, plastic, glass: almost uniform

// cloth.cpp
Picture paint_fabric(const PaintJob& job);
Picture paint_knit(const PaintJob& job);
Picture paint_leather(const PaintJob& job);
Picture paint_carpet(const PaintJob& job);
Picture paint_curtain(const PaintJob& job);
Picture paint_rug(const PaintJob& job);

// print.cpp
Picture paint_book_spines(const PaintJob& job);
Picture paint_book_cover(const PaintJob& job);
Picture paint_poster(const PaintJob& job);
Picture paint_paper(const PaintJob& job);
Picture paint_screen(const PaintJob& job);
Picture paint_whiteboard(const PaintJob& job);

// views.cpp
Picture paint_painting(const PaintJob& job);
Picture paint_garden(const PaintJob& job);
Picture paint_leaf(const PaintJob& job);

}  // namespace mh
