// SPDX-License-Identifier: Apache-2.0
#include "scenes/materials/noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mh {
namespace {

/// Where texels fall between the nodes of a lattice along one axis.
struct Axis {
  std::vector<int> low, high;
  std::vector<float> weight;  ///< of the high node
};

Axis make_axis(int texels, int cells) {
  Axis axis;
  for (int i = 0; i < texels; ++i) {
    const double position = (i + 0.5) * cells / texels;
    const int low = static_cast<int>(position);
    const double t = position - low;
    axis.low.push_back(low % cells);
    axis.high.push_back((low + 1) % cells);
    axis.weight.push_back(static_cast<float>(t * t * t * (t * (t * 6.0 - 15.0) + 10.0)));
  }
  return axis;
}

float signed_uniform(RandomStream random, std::uint64_t index) {
  return static_cast<float>(2.0 * random.uniform(index) - 1.0);
}

void add_value_noise(Field& sum, int cells_x, int cells_y, float height, RandomStream random) {
  const int width = sum.width();
  const Axis across = make_axis(width, cells_x);
  const Axis down = make_axis(sum.height(), cells_y);
  std::vector<float> upper(static_cast<std::size_t>(width)), lower(upper);
  const auto stretch = [&](int node_y, std::vector<float>& row) {
    std::vector<float> nodes(static_cast<std::size_t>(cells_x));
    for (int i = 0; i < cells_x; ++i)
      nodes[i] = height * signed_uniform(random, static_cast<std::uint64_t>(node_y) * cells_x + i);
    for (int x = 0; x < width; ++x)
      row[x] =
          nodes[across.low[x]] + across.weight[x] * (nodes[across.high[x]] - nodes[across.low[x]]);
  };
  int ready = -1;
  for (int y = 0; y < sum.height(); ++y) {
    if (down.low[y] != ready) {
      stretch(down.low[y], upper);
      stretch(down.high[y], lower);
      ready = down.low[y];
    }
    const float t = down.weight[y];
    float* out = sum.row(y).data();
    for (int x = 0; x < width; ++x) out[x] += upper[x] + t * (lower[x] - upper[x]);
  }
}

int wrap(int i, int n) {
  return ((i % n) + n) % n;
}

}  // namespace

Field value_noise(int width, int height, int cells_x, int cells_y, RandomStream random) {
  Field field(width, height);
  add_value_noise(field, cells_x, cells_y, 1.0F, random);
  return field;
}

Field fbm(int width, int height, const Octaves& octaves, RandomStream random) {
  auto [cells_x, cells_y, count, gain] = octaves;
  Field field(width, height);
  float total = 0.0F, octave_height = 1.0F;
  for (int i = 0; i < count; ++i, octave_height *= gain) total += octave_height;
  octave_height = 1.0F / total;
  for (int i = 0; i < count; ++i, octave_height *= gain) {
    if (cells_x > width / 2 && cells_y > height / 2) break;
    add_value_noise(field, std::min(cells_x, width), std::min(cells_y, height), octave_height,
                    random.fork(static_cast<std::uint64_t>(i)));
    cells_x *= 2;
    cells_y *= 2;
  }
  return field;
}

Field white_noise(int width, int height, RandomStream random) {
  // A sum of four uniforms from one draw: close enough to a normal for a texture, and cheap.
  constexpr float kScale = 1.0F / 37837.0F;  // 1 / (65536 * sqrt(4 / 12))
  Field field(width, height);
  std::uint64_t index = 0;
  for (float& value : field) {
    const std::uint64_t b = random.bits(index++);
    const auto sum =
        static_cast<int>((b & 0xffff) + ((b >> 16) & 0xffff) + ((b >> 32) & 0xffff) + (b >> 48));
    value = static_cast<float>(sum - 131070) * kScale;
  }
  return field;
}

float sample(const Field& field, float x, float y) {
  const float fx = std::floor(x), fy = std::floor(y);
  const int x0 = wrap(static_cast<int>(fx), field.width());
  const int y0 = wrap(static_cast<int>(fy), field.height());
  const int x1 = x0 + 1 == field.width() ? 0 : x0 + 1;
  const int y1 = y0 + 1 == field.height() ? 0 : y0 + 1;
  const float tx = x - fx, ty = y - fy;
  const float top = field(x0, y0) + tx * (field(x1, y0) - field(x0, y0));
  const float bottom = field(x0, y1) + tx * (field(x1, y1) - field(x0, y1));
  return top + ty * (bottom - top);
}

Voronoi voronoi(int width, int height, int cells_x, int cells_y, float jitter,
                RandomStream random) {
  Voronoi result{Field(width, height), Field(width, height), Grid2d<int>(width, height)};
  const float cell_w = static_cast<float>(width) / static_cast<float>(cells_x);
  const float cell_h = static_cast<float>(height) / static_cast<float>(cells_y);
  Field px(cells_x, cells_y), py(cells_x, cells_y);
  for (int j = 0; j < cells_y; ++j)
    for (int i = 0; i < cells_x; ++i) {
      const auto k = static_cast<std::uint64_t>(j * cells_x + i);
      px(i, j) = 0.5F + 0.5F * jitter * signed_uniform(random, 2 * k);
      py(i, j) = 0.5F + 0.5F * jitter * signed_uniform(random, 2 * k + 1);
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float fx = (static_cast<float>(x) + 0.5F) / cell_w;
      const float fy = (static_cast<float>(y) + 0.5F) / cell_h;
      const int ci = static_cast<int>(fx), cj = static_cast<int>(fy);
      float best = 1e30F, next = 1e30F;
      int cell = 0;
      for (int j = cj - 1; j <= cj + 1; ++j)
        for (int i = ci - 1; i <= ci + 1; ++i) {
          const int wi = wrap(i, cells_x), wj = wrap(j, cells_y);
          const float dx = static_cast<float>(i) + px(wi, wj) - fx;
          const float dy = static_cast<float>(j) + py(wi, wj) - fy;
          const float d = dx * dx + dy * dy;
          if (d < best) {
            next = best;
            best = d;
            cell = wj * cells_x + wi;
          } else if (d < next) {
            next = d;
          }
        }
      result.nearest(x, y) = std::sqrt(best);
      result.second(x, y) = std::sqrt(next);
      result.cell(x, y) = cell;
    }
  return result;
}

}  // namespace mh
