// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "sim/render/simd.hpp"

namespace mh {

/// sum[i] = weights[0] * rows[0][i] + weights[1] * rows[1][i] + ..., added in this order, for i up
/// to `count` rounded up to a multiple of eight.
inline void weighted_sum(const std::vector<const float*>& rows, const std::vector<float>& weights,
                         std::size_t count, float* sum) {
  for (std::size_t i = 0; i < count; i += 8) {
    Float8 eight = splat(0.0F);
    for (std::size_t k = 0; k < rows.size(); ++k) eight += weights[k] * load8(rows[k] + i);
    _mm256_storeu_ps(sum + i, eight);
  }
}

/// Size of an image with `channels` interleaved floats per pixel.
struct FloatImage {
  int width = 0, height = 0;
  std::size_t channels = 1;
};

/// Blurs an image with a Gaussian, horizontally and then vertically, keeping in memory only the
/// rows that the kernel spans; beyond its borders, the image is extended by its outermost pixels.
/// @param kernel  see gaussian_kernel()
/// @param fill    fill(y, row) writes row y; called for rows in order, before each is used
/// @param use     use(y, row) receives the blurred row y; called for rows in order
template <class Fill, class Use>
void blur_rows(const FloatImage& image, const std::vector<float>& kernel, const Fill& fill,
               const Use& use) {
  const int radius = static_cast<int>(kernel.size()) - 1, span = 2 * radius + 1;
  const std::size_t channels = image.channels, margin = static_cast<std::size_t>(radius) * channels;
  const std::size_t count = static_cast<std::size_t>(image.width) * channels;
  const std::size_t stride = (count + 7) / 8 * 8;
  std::vector<float> weights;
  for (int k = -radius; k <= radius; ++k)
    weights.push_back(kernel[static_cast<std::size_t>(std::abs(k))]);
  std::vector<float> padded(stride + 2 * margin, 0.0F), blurred(stride);
  std::vector<float> ring(stride * static_cast<std::size_t>(span));
  const auto across = [&](int y) {
    return ring.data() + stride * static_cast<std::size_t>(y % span);
  };
  std::vector<const float*> shifted, rows(static_cast<std::size_t>(span));
  for (int k = 0; k < span; ++k)
    shifted.push_back(padded.data() + static_cast<std::size_t>(k) * channels);
  int filled = 0;
  for (int y = 0; y < image.height; ++y) {
    for (; filled < image.height && filled <= y + radius; ++filled) {
      float* row = padded.data() + margin;
      fill(filled, row);
      for (std::size_t i = 0; i < margin; ++i) {
        padded[i] = row[i % channels];
        row[count + i] = row[count - channels + i % channels];
      }
      weighted_sum(shifted, weights, count, across(filled));
    }
    for (int k = 0; k < span; ++k)
      rows[static_cast<std::size_t>(k)] = across(std::clamp(y + k - radius, 0, image.height - 1));
    weighted_sum(rows, weights, count, blurred.data());
    use(y, blurred.data());
  }
}

}  // namespace mh
