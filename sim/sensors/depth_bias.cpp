// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/depth_bias.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace mh {
namespace {

constexpr int kOrders = 3;
constexpr float kMiddle_m = 1.5F;  // where s is 0

/// cos(i pi x) at the centers of n pixels, all orders of one pixel together.
std::vector<std::array<float, kOrders>> cosines(int n) {
  std::vector<std::array<float, kOrders>> all(static_cast<std::size_t>(n));
  for (int x = 0; x < n; ++x)
    for (int i = 0; i < kOrders; ++i)
      all[static_cast<std::size_t>(x)][static_cast<std::size_t>(i)] =
          static_cast<float>(std::cos(i * std::numbers::pi * (x + 0.5) / n));
  return all;
}

/// a_ij and b_ij.
struct Shape {
  std::array<std::array<float, kOrders>, kOrders> fixed = {}, with_distance = {};
};

Shape shape_of(std::uint64_t camera, double rms) {
  const RandomStream stream(camera);
  std::array<std::array<double, kOrders>, kOrders> a = {}, b = {};
  double squares = 0;
  std::uint64_t draw = 0;
  for (std::size_t i = 0; i < kOrders; ++i)
    for (std::size_t j = 0; j < kOrders; ++j) {
      a[i][j] = stream.normal(draw++);
      b[i][j] = stream.normal(draw++);
      if (i == 0 && j == 0) a[i][j] = 0;
      // The mean of cos^2 is 1/2, except for order 0, where it is 1.
      const double mean = (i == 0 ? 1.0 : 0.5) * (j == 0 ? 1.0 : 0.5);
      squares += mean * (a[i][j] * a[i][j] + b[i][j] * b[i][j]);
    }
  Shape shape;
  for (std::size_t i = 0; i < kOrders; ++i)
    for (std::size_t j = 0; j < kOrders; ++j) {
      shape.fixed[i][j] = static_cast<float>(rms / std::sqrt(squares) * a[i][j]);
      shape.with_distance[i][j] = static_cast<float>(rms / std::sqrt(squares) * b[i][j]);
    }
  return shape;
}

Grid2d<float> shifted(const Grid2d<float>& depth_m, int right, int down) {
  Grid2d<float> out(depth_m.width(), depth_m.height());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int u = x + right, v = y + down;
      if (u >= 0 && v >= 0 && u < out.width() && v < out.height()) out(x, y) = depth_m(u, v);
    }
  return out;
}

}  // namespace

Grid2d<float> biased_depth(const Grid2d<float>& depth_m, const DepthBiasConfig& config) {
  const auto right = static_cast<int>(std::lround(config.shift_x_px)),
             down = static_cast<int>(std::lround(config.shift_y_px));
  Grid2d<float> out = right == 0 && down == 0 ? depth_m : shifted(depth_m, right, down);
  const Shape shape = shape_of(config.camera, config.bend);
  const auto scale = static_cast<float>(config.scale);
  const auto across = cosines(out.width()), along = cosines(out.height());
  for (int y = 0; y < out.height(); ++y) {
    // For this row: the coefficients of each cosine in x.
    std::array<float, kOrders> fixed = {}, with_distance = {};
    for (std::size_t i = 0; i < kOrders; ++i)
      for (std::size_t j = 0; j < kOrders; ++j) {
        fixed[i] += shape.fixed[i][j] * along[static_cast<std::size_t>(y)][j];
        with_distance[i] += shape.with_distance[i][j] * along[static_cast<std::size_t>(y)][j];
      }
    for (int x = 0; x < out.width(); ++x) {
      float& z = out(x, y);
      const float s = 1.0F - 2.0F * kMiddle_m / (z + kMiddle_m);
      float f = 0;
      for (std::size_t i = 0; i < kOrders; ++i)
        f += (fixed[i] + s * with_distance[i]) * across[static_cast<std::size_t>(x)][i];
      z *= scale * (1.0F + f);
    }
  }
  return out;
}

}  // namespace mh
