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

using Image = Grid2d<Rgb8>;
using Painter = Image (*)(const PaintJob&);

/// The image whose texel (x, y) is tint_at(x, y).
template <class TintAt>
Image paint(const PaintJob& job, const TintAt& tint_at) {
  Image image(job.width, job.height);
  for (int y = 0; y < job.height; ++y)
    for (int x = 0; x < job.width; ++x) image(x, y) = to_rgb8(tint_at(x, y));
  return image;
}

// wood.cpp: grain along u.
Image paint_wood_grain(const PaintJob& job);
Image paint_wood_boards(const PaintJob& job);
Image paint_parquet(const PaintJob& job);
Image paint_bark(const PaintJob& job);

// walls.cpp
Image paint_plaster(const PaintJob& job);
Image paint_ceiling(const PaintJob& job);
Image paint_tiles(const PaintJob& job);
Image paint_stone(const PaintJob& job);
Image paint_brushed_metal(const PaintJob& job);
Image paint_smooth(const PaintJob& job);  ///< ceramic, plastic, glass: almost uniform

// cloth.cpp
Image paint_fabric(const PaintJob& job);
Image paint_knit(const PaintJob& job);
Image paint_leather(const PaintJob& job);
Image paint_carpet(const PaintJob& job);
Image paint_curtain(const PaintJob& job);
Image paint_rug(const PaintJob& job);

// print.cpp
Image paint_book_spines(const PaintJob& job);
Image paint_book_cover(const PaintJob& job);
Image paint_poster(const PaintJob& job);
Image paint_paper(const PaintJob& job);
Image paint_screen(const PaintJob& job);
Image paint_whiteboard(const PaintJob& job);

// views.cpp
Image paint_painting(const PaintJob& job);
Image paint_garden(const PaintJob& job);
Image paint_leaf(const PaintJob& job);

}  // namespace mh
