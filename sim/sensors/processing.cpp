// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/processing.hpp"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "sim/render/simd.hpp"
#include "sim/sensors/blur_rows.hpp"
#include "sim/sensors/gaussian.hpp"

namespace mh {
namespace {

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

/// What each channel contributes to the luma (Rec. 601), by channel and input gray level.
std::array<Curve, 3> luma_shares(const Curve& curve) {
  std::array<Curve, 3> shares{};
  for (std::size_t v = 0; v < curve.size(); ++v)
    shares[0][v] = 0.299F * curve[v], shares[1][v] = 0.587F * curve[v],
    shares[2][v] = 0.114F * curve[v];
  return shares;
}

void take_luma(std::span<const Rgb8> color, const std::array<Curve, 3>& shares, float* luma) {
  std::size_t x = 0;
  // Loads four bytes for each of eight pixels; the fourth byte belongs to the next pixel.
  const __m256i places = _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21),
                byte = _mm256_set1_epi32(255);
  for (; x + 9 <= color.size(); x += 8) {
    const __m256i pixels =
        _mm256_i32gather_epi32(reinterpret_cast<const int*>(color.data() + x), places, 1);
    const auto share = [&](int channel, __m256i values) {
      return _mm256_i32gather_ps(shares[static_cast<std::size_t>(channel)].data(),
                                 _mm256_and_si256(values, byte), sizeof(float));
    };
    const __m256 red_green =
        _mm256_add_ps(share(0, pixels), share(1, _mm256_srli_epi32(pixels, 8)));
    _mm256_storeu_ps(luma + x, _mm256_add_ps(red_green, share(2, _mm256_srli_epi32(pixels, 16))));
  }
  for (; x < color.size(); ++x)
    luma[x] = shares[0][color[x].r] + shares[1][color[x].g] + shares[2][color[x].b];
}

/// Adds `more` of each pixel to all of its channels, after the curve.
/// @param spread  working memory of three floats per pixel
void sharpen(std::span<Rgb8> color, const Curve& curve, const float* more,
             std::vector<float>& spread) {
  const std::size_t count = 3 * color.size();
  spread.resize(count);
  for (std::size_t x = 0; x < color.size(); ++x)
    spread[3 * x] = spread[3 * x + 1] = spread[3 * x + 2] = more[x];
  auto* bytes = reinterpret_cast<std::uint8_t*>(color.data());
  const auto levels = [&](std::size_t i) {
    const __m256i values =
        _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes + i)));
    const Float8 level =
        (Float8)_mm256_i32gather_ps(curve.data(), values, sizeof(float)) + load8(&spread[i]);
    return _mm256_cvtps_epi32(clamp8(level, 0.0F, 255.0F));
  };
  std::size_t i = 0;
  for (; i + 32 <= count; i += 32) {
    const __m256i mixed = _mm256_packus_epi16(_mm256_packus_epi32(levels(i), levels(i + 8)),
                                              _mm256_packus_epi32(levels(i + 16), levels(i + 24)));
    const __m256i ordered =
        _mm256_permutevar8x32_epi32(mixed, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(bytes + i), ordered);
  }
  for (; i < count; ++i)
    bytes[i] = static_cast<std::uint8_t>(
        std::lrint(std::clamp(curve[bytes[i]] + spread[i], 0.0F, 255.0F)));
}

}  // namespace

void process(Grid2d<Rgb8>& color, const ProcessingConfig& config) {
  if ((config.contrast <= 0.0 && config.sharpening <= 0.0) || color.empty()) return;
  const Curve curve = tone_curve(config.contrast);
  const std::array<Curve, 3> shares = luma_shares(curve);
  const std::vector<float> kernel = gaussian_kernel(config.sharpening_px);
  const auto width = static_cast<std::size_t>(color.width());
  // The luma of the rows that are blurred ahead of the one that is sharpened.
  std::vector<std::vector<float>> ahead(kernel.size(), std::vector<float>(width));
  const auto own = [&](int y) { return ahead[static_cast<std::size_t>(y) % ahead.size()].data(); };
  const auto k_sharp = static_cast<float>(config.sharpening);
  std::vector<float> more(width), spread;
  blur_rows(
      {color.width(), color.height(), 1}, kernel,
      [&](int y, float* luma) {
        take_luma(std::as_const(color).row(y), shares, luma);
        std::copy_n(luma, width, own(y));
      },
      [&](int y, const float* smooth) {
        for (std::size_t x = 0; x < width; ++x) more[x] = k_sharp * (own(y)[x] - smooth[x]);
        sharpen(color.row(y), curve, more.data(), spread);
      });
}

}  // namespace mh
