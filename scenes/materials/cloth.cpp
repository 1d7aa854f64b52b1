// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>

#include "scenes/materials/painters.hpp"

namespace mh {
namespace {

/// Plain weave with threads four texels wide: height of the cloth in about [-1, 1].
float weave(int x, int y) {
  const float u = std::sin(std::numbers::pi_v<float> * (static_cast<float>(x) + 0.5F) / 4.0F);
  const float v = std::sin(std::numbers::pi_v<float> * (static_cast<float>(y) + 0.5F) / 4.0F);
  const bool warp_above = ((x / 4 + y / 4) & 1) == 0;
  return warp_above ? std::abs(u) - 0.6F : std::abs(v) - 0.75F;
}

int round_to(int value, int unit) {
  return std::max(unit, value / unit * unit);
}

}  // namespace

Image paint_fabric(const PaintJob& job) {
  const int w = job.width, h = job.height;
  const Field warp = fbm(w, h, {round_to(w, 4) / 4, 4, 2, 0.5F}, job.random.fork(0));
  const Field weft = fbm(w, h, {4, round_to(h, 4) / 4, 2, 0.5F}, job.random.fork(1));
  const Field broad = fbm(w, h, {7, 7, 4, 0.6F}, job.random.fork(2));
  const Field fuzz = white_noise(w, h, job.random.fork(3));
  return paint(job, [&](int x, int y) {
    const float slubs = ((x / 4 + y / 4) & 1) == 0 ? warp(x, y) : weft(x, y);
    return job.tone * (1.0F + job.variation * (0.22F * weave(x, y) + 0.40F * slubs +
                                               0.10F * broad(x, y) + 0.05F * fuzz(x, y)));
  });
}

Image paint_knit(const PaintJob& job) {
  // Stockinette: columns of V-shaped stitches, each leg leaning toward the center of its column.
  const int columns = std::max(2, job.width / 10), rows = std::max(2, job.height / 8);
  const Field yarn = fbm(job.width, job.height, {columns, rows, 3, 0.7F}, job.random.fork(0));
  const Field broad = fbm(job.width, job.height, {7, 7, 3, 0.5F}, job.random.fork(1));
  return paint(job, [&](int x, int y) {
    const float column = (static_cast<float>(x) + 0.5F) * static_cast<float>(columns) /
                         static_cast<float>(job.width);
    const float across = 2.0F * (column - std::floor(column)) - 1.0F;  // -1 .. 1 in its column
    const float row =
        (static_cast<float>(y) + 0.5F) * static_cast<float>(rows) / static_cast<float>(job.height) +
        0.7F * std::abs(across);
    const float ridge = std::abs(std::sin(std::numbers::pi_v<float> * row));
    const float leg = std::sin(std::numbers::pi_v<float> * std::abs(across));
    const float height = 0.55F * ridge + 0.6F * std::sqrt(std::max(0.0F, leg)) - 0.75F;
    return job.tone *
           (1.0F + job.variation * (0.75F * height + 0.25F * yarn(x, y) + 0.08F * broad(x, y)));
  });
}

Image paint_leather(const PaintJob& job) {
  const int cells = std::max(4, job.width / job.texels(0.009));
  const Voronoi grain = voronoi(job.width, job.height, cells, cells, 1.0F, job.random.fork(0));
  const Field folds = fbm(job.width, job.height, {4, 4, 5, 0.6F}, job.random.fork(1));
  return paint(job, [&](int x, int y) {
    const float crease = smoothstep(0.3F, 0.0F, grain.second(x, y) - grain.nearest(x, y));
    const float wrinkle = smoothstep(0.05F, 0.0F, std::abs(folds(x, y)));
    return job.tone *
           (1.05F + job.variation * (-0.20F * crease - 0.16F * wrinkle + 0.24F * folds(x, y)));
  });
}

Image paint_carpet(const PaintJob& job) {
  const int cells = std::max(4, job.width / job.texels(0.008));
  const Voronoi tufts = voronoi(job.width, job.height, cells, cells, 0.8F, job.random.fork(0));
  const Field broad = fbm(job.width, job.height, {3, 3, 5, 0.6F}, job.random.fork(1));
  const Field pile = white_noise(job.width, job.height, job.random.fork(2));
  const RandomStream shade = job.random.fork(3);
  return paint(job, [&](int x, int y) {
    const auto id = static_cast<std::uint64_t>(tufts.cell(x, y));
    const auto tuft = static_cast<float>(shade.uniform(id, -1.0, 1.0));
    const float hollow = tufts.nearest(x, y);
    return job.tone * (1.0F + job.variation * (0.24F * tuft + 0.22F * (0.4F - hollow) +
                                               0.20F * broad(x, y) + 0.07F * pile(x, y)));
  });
}

Image paint_curtain(const PaintJob& job) {
  // Bands of stripes along v, a small leaf motif between them, and a fine weave over all.
  constexpr int kBands = 4;
  const int w = job.width, h = job.height;
  const Field slubs = fbm(w, h, {w / 3, 6, 2, 0.5F}, job.random.fork(0));
  const float brightness = (job.tone.r + job.tone.g + job.tone.b) / 3.0F;
  const Tint ink = brightness > 120.0F
                       ? blend(job.tone, Tint(60, 50, 60), 0.25F + 0.45F * job.variation)
                       : blend(job.tone, Tint(240, 230, 210), 0.2F + 0.4F * job.variation);
  const Tint light = blend(job.tone, Tint(255, 250, 240), 0.35F);
  const float band = static_cast<float>(w) / kBands;
  return paint(job, [&](int x, int y) {
    const float u = std::fmod(static_cast<float>(x), band) / band;
    Tint tint = job.tone;
    if (u < 0.16F || (u > 0.22F && u < 0.25F) || (u > 0.94F && u < 0.97F)) tint = ink;
    if (u > 0.17F && u < 0.21F) tint = light;
    const int motifs = 6;
    const float v = std::fmod(static_cast<float>(y) / static_cast<float>(h) * motifs, 1.0F) - 0.5F;
    const float du = (u - 0.6F) * band * motifs / static_cast<float>(h);
    const float side = std::abs(du) - 0.20F * std::sin(std::numbers::pi_v<float> * (v + 0.5F));
    const bool leaf = std::abs(v) < 0.36F && std::abs(side) < 0.05F && std::abs(du) > 0.02F;
    if (leaf || (std::abs(du) < 0.018F && std::abs(v) < 0.45F)) tint = ink;
    return tint * (1.0F + 0.06F * weave(x, y) + 0.10F * slubs(x, y));
  });
}

Image paint_rug(const PaintJob& job) {
  const Tint dark = blend(job.tone, Tint(20, 22, 45), 0.72F);
  const Tint cream(226, 208, 170);
  const Tint accent = blend(Tint(job.tone.b, job.tone.r * 0.6F, job.tone.g), cream, 0.25F);
  const std::array<Tint, 4> palette = {job.tone, dark, cream, accent};
  const Field pile = white_noise(job.width, job.height, job.random.fork(0));
  const Field broad = fbm(job.width, job.height, {4, 4, 4, 0.6F}, job.random.fork(1));
  const auto w = static_cast<float>(job.width), h = static_cast<float>(job.height);
  const auto petals = 6.0F + 2.0F * static_cast<float>(job.random.below(1, 3));
  const float unit = 0.045F * std::min(w, h);  // width of the thinnest band of the border

  const auto ornament = [&](float x, float y) -> std::size_t {  // texels from the rug's middle
    const float border = std::min(0.5F * w - std::abs(x), 0.5F * h - std::abs(y)) / unit;
    const bool on_side = 0.5F * w - std::abs(x) < 0.5F * h - std::abs(y);
    const float along = (on_side ? y : x) / unit;
    const float phase = std::abs(along / 2.0F - std::round(along / 2.0F)) * 2.0F;  // 0 .. 1
    if (border < 0.5F) return 1;
    if (border < 0.8F) return 2;
    if (border < 2.8F) {  // a row of stepped diamonds with eyes
      const float diamond = std::abs(border - 1.8F) + phase;
      return diamond < 0.3F ? 3 : diamond < 0.65F ? 2 : diamond < 0.85F ? 1 : 0;
    }
    if (border < 3.1F) return 1;
    if (border < 3.9F) return std::fmod(std::abs(along) + border, 1.0F) < 0.5F ? 3 : 2;
    if (border < 4.2F) return 1;
    const float radius = std::hypot(x, y) / unit;
    const float lobes = 1.0F + 0.22F * std::cos(petals * std::atan2(y, x));
    const float ring = radius / lobes;
    if (ring < 4.6F) {  // the medallion
      if (ring < 0.8F) return 2;
      if (ring < 1.6F) return 1;
      if (ring < 2.4F) return std::cos(2.0F * petals * std::atan2(y, x)) > 0.0F ? 2 : 3;
      return ring < 2.7F ? 1 : ring < 3.9F ? 3 : ring < 4.2F ? 2 : 1;
    }
    const float cx = x / (2.4F * unit) - std::round(x / (2.4F * unit));
    const float cy = y / (2.4F * unit) - std::round(y / (2.4F * unit));
    const float flower = std::hypot(cx, cy) * (1.0F + 0.35F * std::cos(4.0F * std::atan2(cy, cx)));
    if (flower < 0.10F) return 2;
    if (flower < 0.24F) return 3;
    if (flower < 0.29F) return 1;
    return std::abs(std::abs(cx) - std::abs(cy)) < 0.035F ? 1 : 0;
  };
  return paint(job, [&](int x, int y) {
    const Tint tint = palette[ornament(static_cast<float>(x) + 0.5F - 0.5F * w,
                                       static_cast<float>(y) + 0.5F - 0.5F * h)];
    return tint * (1.0F + (0.4F + job.variation) * (0.06F * pile(x, y) + 0.16F * broad(x, y)));
  });
}

}  // namespace mh
