// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "scenes/materials/painters.hpp"

namespace mh {
namespace {

/// Bends the growth rings around a few knots and darkens the knots' cores.
void add_knots(const PaintJob& job, int count, Field& rings, Field& darkness) {
  const RandomStream random = job.random.fork(1);
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::uint64_t>(4 * k);
    const int cx = static_cast<int>(random.uniform(i) * job.width);
    const int cy = static_cast<int>(random.uniform(i + 1) * job.height);
    const float radius = static_cast<float>(job.texels(random.uniform(i + 2, 0.012, 0.028)));
    const int reach_x = std::min(job.width / 2, static_cast<int>(6.0F * radius));
    const int reach_y = std::min(job.height / 2, static_cast<int>(2.5F * radius));
    for (int dy = -reach_y; dy < reach_y; ++dy)
      for (int dx = -reach_x; dx < reach_x; ++dx) {
        const float e = std::hypot(static_cast<float>(dx) / 2.4F, static_cast<float>(dy)) / radius;
        const int x = (cx + dx + job.width) % job.width, y = (cy + dy + job.height) % job.height;
        rings(x, y) += 4.0F * std::exp(-e * e);
        darkness(x, y) += 1.1F * smoothstep(0.75F, 0.25F, e);
      }
  }
}

/// How much darker than its mean a plank is at each texel, about -0.5 to 1: growth rings cut
/// lengthwise (long lines that close into arches, the "cathedral" figure), fibers, pores and knots.
/// The grain runs along x.
Field wood_darkness(const PaintJob& job) {
  constexpr double kRingSpacing = 0.016;
  const int w = job.width, h = job.height;
  const auto cells = [&](int texels, double spacing_m) {
    return std::max(1, texels / job.texels(spacing_m));
  };
  Field rings = fbm(w, h, {cells(w, 0.9), cells(h, 0.17), 4, 0.42F}, job.random.fork(2));
  Field darkness = fbm(w, h, {cells(w, 0.30), cells(h, 0.009), 2, 0.8F}, job.random.fork(3));
  const Field pores = value_noise(w, h, cells(w, 0.025), h / 2, job.random.fork(4));
  const Field broad = fbm(w, h, {cells(w, 0.6), cells(h, 0.1), 2, 0.5F}, job.random.fork(5));
  const int count = cells(h, kRingSpacing);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      rings(x, y) = 9.0F * rings(x, y) +
                    static_cast<float>(count) * static_cast<float>(y) / static_cast<float>(h);
  Field cores(w, h);
  const double area_m2 = static_cast<double>(w) * h * job.texel_m * job.texel_m;
  add_knots(job, static_cast<int>(area_m2 * 2.2 + 0.5), rings, cores);
  double sum = 0.0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const float phase = rings(x, y) - std::floor(rings(x, y));
      const float late = smoothstep(0.15F, 0.85F, phase) * smoothstep(1.0F, 0.88F, phase);
      float& d = darkness(x, y);
      d = 0.45F * late + 0.30F * d + 0.25F * broad(x, y) + cores(x, y) +
          0.35F * smoothstep(0.55F, 0.85F, pores(x, y));
      sum += d;
    }
  const auto mean = static_cast<float>(sum / static_cast<double>(darkness.size()));
  for (float& d : darkness) d -= mean;
  return darkness;
}

/// Dark wood is redder than light wood of the same tree.
Tint wood_tint(const PaintJob& job, float darkness, float shade = 0.0F) {
  const float d = std::min(job.variation * darkness * 0.85F, 0.85F) + shade;
  return {job.tone.r * (1.0F - 0.8F * d), job.tone.g * (1.0F - d), job.tone.b * (1.0F - 1.12F * d)};
}

/// One plank or block: where it was cut from the sheet of wood, and how it differs from the mean.
struct Plank {
  int offset_x = 0, offset_y = 0;
  float shade = 0.0F;
};

Plank cut_plank(const PaintJob& job, std::uint64_t index) {
  const RandomStream random = job.random.fork(6);
  return {static_cast<int>(random.below(3 * index, job.width)),
          static_cast<int>(random.below(3 * index + 1, job.height)),
          job.variation * static_cast<float>(random.uniform(3 * index + 2, -0.2, 0.2))};
}

float plank_darkness(const Field& wood, const Plank& plank, int along, int across) {
  return wood((along + plank.offset_x) % wood.width(), (across + plank.offset_y) % wood.height());
}

/// Darkening near the joints: the gap itself and the rounded edge next to it.
float joint(int distance_texels) {
  return distance_texels == 0 ? 0.55F : distance_texels == 1 ? 0.16F : 0.0F;
}

}  // namespace

Image paint_wood_grain(const PaintJob& job) {
  const Field wood = wood_darkness(job);
  return paint(job, [&](int x, int y) { return wood_tint(job, wood(x, y)); });
}

Image paint_wood_boards(const PaintJob& job) {
  const Field wood = wood_darkness(job);
  const int rows = std::max(1, job.height / job.texels(0.12));
  const int boards = 2;  // per row: one board is half a repeat long
  std::vector<int> start(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row)
    start[row] =
        static_cast<int>(job.random.fork(7).uniform(static_cast<std::uint64_t>(row)) * job.width);
  return paint(job, [&](int x, int y) {
    const int row = y * rows / job.height;
    const int top = (row * job.height + rows - 1) / rows;
    const int along = (x + start[row]) % job.width;
    const int board = along * boards / job.width;
    const int left = (board * job.width + boards - 1) / boards;
    const Plank plank = cut_plank(job, static_cast<std::uint64_t>(row * boards + board));
    const float edge = joint(std::min(y - top, along - left));
    return wood_tint(job, plank_darkness(wood, plank, along, y), plank.shade + edge);
  });
}

Image paint_parquet(const PaintJob& job) {
  // Herringbone: on a lattice of block widths, k = (i - j) mod 2n gives the position of a cell in
  // its horizontal (k < n) or vertical block of n cells.
  constexpr int kLength = 5;
  const Field wood = wood_darkness(job);
  const int cells =
      std::max(2 * kLength, job.width / job.texels(0.07) / (2 * kLength) * 2 * kLength);
  const float cell = static_cast<float>(job.width) / static_cast<float>(cells);
  return paint(job, [&](int x, int y) {
    const int i = static_cast<int>(static_cast<float>(x) / cell);
    const int j = static_cast<int>(static_cast<float>(y) / cell);
    const int k = ((i - j) % (2 * kLength) + 2 * kLength) % (2 * kLength);
    const bool flat = k < kLength;
    const int bi = flat ? (i - k + cells) % cells : i;
    const int bj = flat ? j : (j - (2 * kLength - 1 - k) + cells) % cells;
    const Plank plank = cut_plank(job, static_cast<std::uint64_t>((bj * cells + bi) * 2 + flat));
    const auto first = [&](int index) { return static_cast<int>(std::ceil(index * cell)); };
    const int in_x = x - first(flat ? i - k : i);
    const int in_y = y - first(flat ? j : j - (2 * kLength - 1 - k));
    const float edge = joint(std::min(in_x, in_y));
    const float dark =
        flat ? plank_darkness(wood, plank, in_x, in_y) : plank_darkness(wood, plank, in_y, in_x);
    // Blocks laid in the other direction reflect light differently.
    return wood_tint(job, dark, plank.shade + edge + (flat ? 0.03F : -0.03F));
  });
}

Image paint_bark(const PaintJob& job) {
  const Voronoi plates = voronoi(job.width, job.height, std::max(3, job.width / job.texels(0.03)),
                                 std::max(3, job.height / job.texels(0.1)), 0.9F, job.random);
  const Field rough = fbm(job.width, job.height, {24, 10, 5, 0.7F}, job.random.fork(1));
  return paint(job, [&](int x, int y) {
    const float ridge = smoothstep(0.0F, 0.4F, plates.second(x, y) - plates.nearest(x, y));
    const float light = 0.45F + 0.6F * ridge + 0.9F * job.variation * rough(x, y);
    return job.tone * light;
  });
}

}  // namespace mh
