// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "sim/render/color.hpp"
#include "sim/sensors/gaussian.hpp"
#include "sim/sensors/lens.hpp"

namespace mh {
namespace {

using LightRow = std::vector<float>;  // a row, three channels side by side

void add(LightRow& sum, const LightRow& row, float weight) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * row[i];
}

/// One row in linear light, blurred horizontally.
LightRow blurred_row(std::span<const Rgb8> row, const std::vector<float>& kernel) {
  const std::size_t radius = kernel.size() - 1, n = row.size();
  LightRow padded;
  for (std::size_t i = 0; i < n + 2 * radius; ++i) {
    const std::size_t x = std::min(i > radius ? i - radius : 0, n - 1);
    for (const std::uint8_t v : {row[x].r, row[x].g, row[x].b}) padded.push_back(srgb_to_linear(v));
  }
  LightRow sum(3 * n, 0.0F);
  for (std::size_t k = 0; k <= 2 * radius; ++k) {
    const float weight = kernel[k > radius ? k - radius : radius - k];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * padded[i + 3 * k];
  }
  return sum;
}

}  // namespace

void blur_by_lens(Grid2d<Rgb8>& color, double sigma_px) {
  if (sigma_px <= 0.0 || color.empty()) return;
  const std::vector<float> kernel = gaussian_kernel(sigma_px);
  const int radius = static_cast<int>(kernel.size()) - 1, last = color.height() - 1;
  std::vector<LightRow> rows;
  for (int y = 0; y <= last; ++y) rows.push_back(blurred_row(std::as_const(color).row(y), kernel));
  for (int y = 0; y <= last; ++y) {
    LightRow sum(rows[0].size(), 0.0F);
    for (int k = -radius; k <= radius; ++k)
      add(sum, rows[static_cast<std::size_t>(std::clamp(y + k, 0, last))],
          kernel[static_cast<std::size_t>(std::abs(k))]);
    const float* light = sum.data();
    for (Rgb8& c : color.row(y)) {
      c = {linear_to_srgb(light[0]), linear_to_srgb(light[1]), linear_to_srgb(light[2])};
      light += 3;
    }
  }
}

}  // namespace mh
