// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Mean colour of a picture in linear light; white if it is empty.
Eigen::Vector3f mean_linear(const Grid2d<Rgb8>& picture);

/// A repeating texture with its mip pyramid, filtered in linear light. Texels are four 16-bit
/// channels (the fourth unused). Each level has a copy of its first column and row at its end, so
/// that the two neighbours of a lookup are always one 16-byte load apart from any wrapping.
class MipTexture {
 public:
  MipTexture() = default;
  explicit MipTexture(const Grid2d<Rgb8>& picture);

  bool empty() const { return levels_ == 0; }
  int width() const { return levels_ ? static_cast<int>(level_[0].width) : 0; }
  int height() const { return levels_ ? static_cast<int>(level_[0].height) : 0; }

  /// The level at which a pixel that covers so many texels of level 0 covers one: half the
  /// logarithm to base 2, to within 0.05.
  static float level_of(float texels) {
    const float log2 =
        static_cast<float>(std::bit_cast<std::int32_t>(texels)) * 0x1.0p-23F - 127.0F;
    return 0.5F * log2;
  }

  /// Trilinear lookup: linear RGB, channel 3 = 0. Texel centres lie at half-integers,
  /// (u, v) = (0, 0) is the outer corner of the first texel. Level 0 is the full picture.
  __m128 sample(float u, float v, float level) const {
    const float clamped = std::min(std::max(level, 0.0F), static_cast<float>(levels_ - 1));
    const int fine = static_cast<int>(clamped);
    const int coarse = std::min(fine + 1, levels_ - 1);
    const float blend = clamped - static_cast<float>(fine);
    u -= std::floor(u);
    v -= std::floor(v);
    const __m256 pair =
        _mm256_add_ps(_mm256_mul_ps(_mm256_set1_ps(1.0F - blend),
                                    bilinear_pair(level_[static_cast<std::size_t>(fine)], u, v)),
                      _mm256_mul_ps(_mm256_set1_ps(blend),
                                    bilinear_pair(level_[static_cast<std::size_t>(coarse)], u, v)));
    return _mm_mul_ps(_mm_set1_ps(1.0F / kWhite),
                      _mm_add_ps(_mm256_castps256_ps128(pair), _mm256_extractf128_ps(pair, 1)));
  }

 private:
  static constexpr float kWhite = 65535.0F;

  struct Level {
    float width = 0, height = 0;
    std::uint32_t offset = 0;  // of the first texel, in texels
    std::uint32_t stride = 0;  // texels per row
  };

  /// The weighted left and right column of a 2x2 lookup; their sum is the bilinear value.
  __m256 bilinear_pair(const Level& level, float u, float v) const {
    float x = u * level.width - 0.5F;
    float y = v * level.height - 0.5F;
    x = x < 0.0F ? x + level.width : x;
    y = y < 0.0F ? y + level.height : y;
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const std::uint16_t* upper =
        texels_.data() + 4 * (level.offset + static_cast<std::uint32_t>(y0) * level.stride +
                              static_cast<std::uint32_t>(x0));
    const std::uint16_t* lower = upper + 4 * level.stride;
    const __m256 a = load_pair(upper), b = load_pair(lower);
    const __m256 column = _mm256_add_ps(a, _mm256_mul_ps(_mm256_set1_ps(fy), _mm256_sub_ps(b, a)));
    const __m256 weight = _mm256_set_m128(_mm_set1_ps(fx), _mm_set1_ps(1.0F - fx));
    return _mm256_mul_ps(weight, column);
  }

  static __m256 load_pair(const std::uint16_t* texel) {
    const __m128i raw = _mm_loadu_si128(reinterpret_cast<const __m128i*>(texel));
    return _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(raw));
  }

  std::array<Level, 16> level_{};
  int levels_ = 0;
  std::vector<std::uint16_t> texels_;
};

}  // namespace mh
