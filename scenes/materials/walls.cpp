// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "scenes/materials/painters.hpp"

namespace mh {

Image paint_plaster(const PaintJob& job) {
  const Field broad = fbm(job.width, job.height, {3, 3, 4, 0.5F}, job.random.fork(0));
  const Field roller =
      fbm(job.width, job.height, {job.width / 4, job.height / 3, 2, 0.7F}, job.random.fork(1));
  return paint(job, [&](int x, int y) {
    return job.tone * (1.0F + job.variation * (0.035F * broad(x, y) + 0.022F * roller(x, y)));
  });
}

Image paint_ceiling(const PaintJob& job) {
  const Field broad = fbm(job.width, job.height, {2, 2, 3, 0.5F}, job.random.fork(0));
  const Field grain = white_noise(job.width, job.height, job.random.fork(1));
  return paint(job, [&](int x, int y) {
    return job.tone * (1.0F + job.variation * (0.02F * broad(x, y) + 0.004F * grain(x, y)));
  });
}

Image paint_tiles(const PaintJob& job) {
  const int count_x = std::max(1, job.width / job.texels(0.2));
  const int count_y = std::max(1, job.height / job.texels(0.2));
  const Field cloud = fbm(job.width, job.height, {14, 14, 4, 0.55F}, job.random.fork(0));
  const Field grout_grain = white_noise(job.width, job.height, job.random.fork(1));
  const float brightness = (job.tone.r + job.tone.g + job.tone.b) / 3.0F;
  const Tint grout = brightness > 150.0F ? job.tone * 0.66F : job.tone * 1.35F;
  return paint(job, [&](int x, int y) {
    const int i = x * count_x / job.width, j = y * count_y / job.height;
    const int left = (i * job.width + count_x - 1) / count_x;
    const int top = (j * job.height + count_y - 1) / count_y;
    const int right = ((i + 1) * job.width + count_x - 1) / count_x - 1;
    const int bottom = ((j + 1) * job.height + count_y - 1) / count_y - 1;
    const int edge = std::min(std::min(x - left, right - x), std::min(y - top, bottom - y));
    if (edge == 0) return grout * (1.0F + 0.05F * grout_grain(x, y));
    const auto id = static_cast<std::uint64_t>(j * count_x + i);
    const auto shade = static_cast<float>(job.random.fork(2).uniform(id, -1.0, 1.0));
    const float rim = edge == 1 ? (x - left == 1 || y - top == 1 ? 0.05F : -0.05F) : 0.0F;
    // Each tile shows a different part of the noise.
    const int shift = static_cast<int>(job.random.fork(3).below(id, job.width));
    const float c = cloud((x + shift) % job.width, y);
    return job.tone * (1.0F + rim + job.variation * (0.09F * shade + 0.10F * c));
  });
}

Image paint_stone(const PaintJob& job) {
  const int cells = std::max(4, job.width / job.texels(0.007));
  const Voronoi grains = voronoi(job.width, job.height, cells, cells, 1.0F, job.random.fork(0));
  const Field broad = fbm(job.width, job.height, {6, 6, 4, 0.6F}, job.random.fork(1));
  const RandomStream pick = job.random.fork(2);
  return paint(job, [&](int x, int y) {
    const auto id = static_cast<std::uint64_t>(grains.cell(x, y));
    const double kind = pick.uniform(2 * id) + 0.10 * broad(x, y);
    const auto shade = static_cast<float>(pick.uniform(2 * id + 1, -0.10, 0.10));
    const float level = kind < 0.16 ? -0.75F : kind < 0.36 ? -0.30F : kind > 0.86 ? 0.55F : 0.10F;
    return job.tone * (1.0F + job.variation * (0.7F * level + shade + 0.16F * broad(x, y)));
  });
}

Image paint_brushed_metal(const PaintJob& job) {
  const Field lines = fbm(job.width, job.height, {3, job.height / 4, 2, 0.9F}, job.random.fork(0));
  const Field broad = fbm(job.width, job.height, {2, 3, 2, 0.5F}, job.random.fork(1));
  return paint(job, [&](int x, int y) {
    return job.tone * (1.0F + job.variation * (0.09F * lines(x, y) + 0.08F * broad(x, y)));
  });
}

Image paint_smooth(const PaintJob& job) {
  const Field broad = fbm(job.width, job.height, {2, 2, 2, 0.5F}, job.random.fork(0));
  const Field grain = white_noise(job.width, job.height, job.random.fork(1));
  return paint(job, [&](int x, int y) {
    return job.tone * (1.0F + job.variation * (0.015F * broad(x, y) + 0.003F * grain(x, y)));
  });
}

}  // namespace mh
