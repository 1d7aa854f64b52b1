// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "scenes/materials/canvas.hpp"
#include "scenes/materials/painters.hpp"

namespace mh {
namespace {

Tint sky_tint(float height, float cloud) {
  const Tint blue = blend(Tint(196, 216, 232), Tint(92, 144, 204), height);
  return blend(blue, Tint(246, 246, 244), smoothstep(0.05F, 0.45F, cloud));
}

}  // namespace

Image paint_painting(const PaintJob& job) {
  const int w = job.width, h = job.height;
  const Field stroke_x = fbm(w, h, {7, 7, 3, 0.6F}, job.random.fork(0));
  const Field stroke_y = fbm(w, h, {7, 7, 3, 0.6F}, job.random.fork(1));
  const Field clouds = fbm(w, h, {3, 6, 5, 0.55F}, job.random.fork(2));
  const Field ridges = fbm(w, 16, {3, 1, 5, 0.5F}, job.random.fork(3));
  const Field dabs = fbm(w, h, {w / 9, h / 4, 3, 0.75F}, job.random.fork(4));
  const Field canvas_grain = white_noise(w, h, job.random.fork(5));
  const float horizon = static_cast<float>(job.random.fork(6).uniform(0, 0.38, 0.52));
  const Tint warm(238, 196, 128);
  // Every dab takes its color from a nearby point, like a brush.
  const auto scenery = [&](float x, float y) {
    const float v = y / static_cast<float>(h);
    const int column = std::clamp(static_cast<int>(x), 0, w - 1);
    Tint tint = sky_tint(1.0F - v / horizon, sample(clouds, x, y) + 0.1F);
    tint = blend(tint, warm, 0.5F * smoothstep(0.0F, horizon, v));
    for (int i = 0; i < 4; ++i) {
      const auto depth = static_cast<float>(i);
      const float crest = horizon + 0.11F * (depth - 0.6F) + 0.16F * ridges(column, 4 * i);
      if (v < crest) continue;
      const Tint land = blend(blend(job.tone, Tint(110, 130, 165), 0.75F - 0.22F * depth),
                              i % 2 == 0 ? Tint(52, 84, 50) : Tint(186, 150, 70), 0.35F);
      tint = land * (1.1F - 0.5F * (v - crest));
    }
    return tint;
  };
  Image image = paint(job, [&](int x, int y) {
    const float sx = static_cast<float>(x) + 14.0F * stroke_x(x, y) + 5.0F * dabs(x, y);
    const float sy = static_cast<float>(y) + 8.0F * stroke_y(x, y) + 7.0F * dabs(x, y);
    return scenery(sx, sy) * (1.0F + 0.22F * dabs(x, y) + 0.012F * canvas_grain(x, y));
  });
  Canvas canvas(image);
  const RandomStream trees = job.random.fork(7);
  const auto height = static_cast<float>(h);
  for (std::uint64_t i = 0; i < 26; ++i) {  // trees, smaller with distance
    const auto depth = static_cast<float>(trees.uniform(8 * i));
    const float x = static_cast<float>(trees.uniform(8 * i + 1)) * static_cast<float>(w);
    const float y = (horizon + 0.08F + 0.45F * depth) * height;
    const float size = (0.02F + 0.09F * depth) * height;
    const Tint dark =
        blend(Tint(36, 58, 36), job.tone, static_cast<float>(trees.uniform(8 * i + 2, 0, 0.5)));
    canvas.line(x, y, x, y - 0.6F * size, std::max(1.0F, 0.1F * size), Tint(62, 44, 32));
    for (std::uint64_t k = 0; k < 5; ++k) {
      const auto dx = static_cast<float>(trees.fork(k).uniform(8 * i + 3, -0.4, 0.4));
      const auto dy = static_cast<float>(trees.fork(k).uniform(8 * i + 4, -0.5, 0.3));
      canvas.ellipse(x + dx * size, y - (1.0F + dy) * size, 0.3F * size, 0.22F * size, dx,
                     dark * (1.0F + 0.25F * static_cast<float>(k) * 0.4F));
    }
  }
  return image;
}

Image paint_garden(const PaintJob& job) {
  const int w = job.width, h = job.height;
  const int widths = std::max(1, w / (2 * h));  // a wide image shows more, not wider things
  const Field clouds = fbm(w, h, {3 * widths, 5, 5, 0.55F}, job.random.fork(0));
  const Field crowns = fbm(w, h, {5 * widths, 5, 6, 0.6F}, job.random.fork(1));
  const Field leaves = fbm(w, h, {w / 7, h / 7, 3, 0.8F}, job.random.fork(2));
  const Field tops = fbm(w, 16, {4 * widths, 1, 5, 0.55F}, job.random.fork(3));
  const Field grass = fbm(w, h, {w / 3, h / 9, 2, 0.8F}, job.random.fork(4));
  const Voronoi hedge =
      voronoi(w, h, std::max(3, w / 6), std::max(3, h / 6), 1.0F, job.random.fork(5));
  const Tint green = blend(Tint(70, 108, 52), job.tone, 0.25F);
  Image image = paint(job, [&](int x, int y) {
    const float v = static_cast<float>(y) / static_cast<float>(h);
    const float far = 0.36F + 0.22F * tops(x, 0), near = 0.50F + 0.03F * tops(x, 8);
    if (v > 0.70F + 0.008F * leaves(x, 3)) {  // lawn, mown in bands
      const float band = 0.05F * std::sin(40.0F * v * v);
      return Tint(112, 146, 66) * (0.98F + band + 0.22F * grass(x, y));
    }
    if (v > near) {  // hedge: lit above, dark between the leaves
      const float gap = 1.2F * hedge.nearest(x, y);
      const float light = 1.15F - 1.2F * (v - near);
      return green * (light * (1.05F - 0.5F * gap + 0.35F * leaves(x, y)));
    }
    if (v + 0.10F * crowns(x, y) > far) {  // trees behind it
      const float lit = 0.85F + 0.7F * crowns(x, y) + 0.3F * leaves(x, y);
      return blend(Tint(84, 116, 70), Tint(150, 172, 160), 0.25F) * lit;
    }
    return sky_tint(1.0F - 1.6F * v, clouds(x, y) + 0.05F);
  });
  Canvas canvas(image);
  const auto height = static_cast<float>(h);
  for (int tree = 0; tree < widths; ++tree) {
    const RandomStream random = job.random.fork(6).fork(static_cast<std::uint64_t>(tree));
    const float place =
        static_cast<float>(tree) + static_cast<float>(random.uniform(0, 0.15, 0.85));
    const float x = place / static_cast<float>(widths) * static_cast<float>(w);
    canvas.line(x, 0.76F * height, x + 0.02F * height, 0.2F * height, 0.035F * height,
                Tint(82, 66, 52));
    canvas.line(x + 0.01F * height, 0.45F * height, x + 0.14F * height, 0.2F * height,
                0.015F * height, Tint(74, 60, 48));
    for (std::uint64_t i = 0; i < 260; ++i) {  // its crown
      const auto turn = static_cast<float>(random.uniform(10 + 4 * i, 0.0, 6.28));
      const auto reach = static_cast<float>(std::sqrt(random.uniform(11 + 4 * i))) * 0.24F * height;
      const auto shade = static_cast<float>(random.uniform(12 + 4 * i, 0.6, 1.35));
      canvas.ellipse(x + 0.03F * height + 1.3F * reach * std::cos(turn),
                     0.14F * height + 0.8F * reach * std::sin(turn), 0.016F * height,
                     0.010F * height, turn, green * shade);
    }
  }
  return image;
}

Image paint_leaf(const PaintJob& job) {
  // One leaf: its midrib along u in the middle of v, side veins leaving it at an angle.
  const Field mottle = fbm(job.width, job.height, {4, 4, 5, 0.6F}, job.random.fork(0));
  const Field cells =
      fbm(job.width, job.height, {std::max(2, job.width / 4), std::max(2, job.height / 4), 1, 1.0F},
          job.random.fork(1));
  const Tint vein = blend(job.tone, Tint(222, 230, 160), 0.5F);
  return paint(job, [&](int x, int y) {
    const float u = static_cast<float>(x) / static_cast<float>(job.width);
    const float v =
        std::abs(2.0F * (static_cast<float>(y) + 0.5F) / static_cast<float>(job.height) - 1.0F);
    const float along = (u - 0.30F * v) * 11.0F + 0.5F * mottle(x, y);
    const float side = std::abs(along - std::round(along)) * 2.0F;
    const float rib = smoothstep(0.04F + 0.05F * (1.0F - u), 0.02F, v);
    const float ribs = smoothstep(0.16F, 0.05F, side) * (1.0F - 0.6F * v);
    const float between = 0.88F + 0.16F * side - 0.12F * v;
    const float light = between + job.variation * (0.35F * mottle(x, y) + 0.10F * cells(x, y));
    return blend(job.tone * light, vein, std::max(0.9F * rib, 0.6F * ribs));
  });
}

}  // namespace mh
