// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/processing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/sensors/gaussian.hpp"

namespace mh {
namespace {

using Row = std::vector<float>;
using Curve = std::array<float, 256>;  // output gray level by input gray level

Curve tone_curve(double contrast) {
  Curve curve{};
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double v = static_cast<double>(i) / 255.0;
    curve[i] =
        static_cast<float>(255.0 * ((1.0 - contrast) * v + contrast * v * v * (3.0 - 2.0 * v)));
  }
  return curve;
}

/// Blurs a row; beyond its ends it is extended by its last value.
Row blurred(const Row& row, const std::vector<float>& kernel) {
  const int last = static_cast<int>(row.size()) - 1, radius = static_cast<int>(kernel.size()) - 1;
  Row sum(row.size(), 0.0F);
  for (int k = -radius; k <= radius; ++k) {
    const float weight = kernel[static_cast<std::size_t>(std::abs(k))];
    for (int x = 0; x <= last; ++x)
      sum[static_cast<std::size_t>(x)] +=
          weight * row[static_cast<std::size_t>(std::clamp(x + k, 0, last))];
  }
  return sum;
}

}  // namespace

void process(Grid2d<Rgb8>& color, const ProcessingConfig& config) {
  if ((config.contrast <= 0.0 && config.sharpening <= 0.0) || color.empty()) return;
  const Curve curve = tone_curve(config.contrast);
  const std::vector<float> kernel = gaussian_kernel(config.sharpening_px);
  const int last = color.height() - 1, radius = static_cast<int>(kernel.size()) - 1;
  std::vector<Row> luma, across;  // and the same blurred horizontally
  for (int y = 0; y <= last; ++y) {
    Row row;
    for (const Rgb8 c : std::as_const(color).row(y))
      row.push_back(0.299F * curve[c.r] + 0.587F * curve[c.g] + 0.114F * curve[c.b]);
    across.push_back(blurred(row, kernel));
    luma.push_back(std::move(row));
  }
  const auto k_sharp = static_cast<float>(config.sharpening);
  Row smooth(luma.front().size());
  for (int y = 0; y <= last; ++y) {
    std::fill(smooth.begin(), smooth.end(), 0.0F);
    for (int k = -radius; k <= radius; ++k) {
      const Row& row = across[static_cast<std::size_t>(std::clamp(y + k, 0, last))];
      const float weight = kernel[static_cast<std::size_t>(std::abs(k))];
      for (std::size_t x = 0; x < smooth.size(); ++x) smooth[x] += weight * row[x];
    }
    const Row& own = luma[static_cast<std::size_t>(y)];
    std::size_t x = 0;
    for (Rgb8& c : color.row(y)) {
      const float more = k_sharp * (own[x] - smooth[x]);
      ++x;
      const auto level = [&](std::uint8_t v) {
        return static_cast<std::uint8_t>(std::lrint(std::clamp(curve[v] + more, 0.0F, 255.0F)));
      };
      c = {level(c.r), level(c.g), level(c.b)};
    }
  }
}

}  // namespace mh
