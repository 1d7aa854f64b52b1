// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <immintrin.h>

#include "sim/render/color.hpp"

namespace mh {

/// Clamps light to [0, 1]: anything brighter than white is white.
inline __m256 up_to_white(__m256 linear) {
  return _mm256_min_ps(_mm256_max_ps(linear, _mm256_setzero_ps()), _mm256_set1_ps(1.0F));
}

/// How many bytes past the end of each row encode() overwrites.
inline constexpr std::size_t kSpareAfterEncode = 4;

/// Converts eight linear colors, in pairs, to sRGB: the same as linear_to_srgb(), except that half
/// steps of the table round to even.
/// @param first, second  destinations of the first and the last four pixels, with kSpareAfterEncode
///                       spare bytes
inline void encode(const __m256* light, Rgb8* first, Rgb8* second) {
  const auto* table = reinterpret_cast<const int*>(kSrgbTable.data());
  const auto code = [&](__m256 linear) {
    const __m256i level =
        _mm256_cvtps_epi32(_mm256_mul_ps(up_to_white(linear), _mm256_set1_ps(kSrgbTableMax)));
    return _mm256_and_si256(_mm256_i32gather_epi32(table, level, 1), _mm256_set1_epi32(0xFF));
  };
  // Pixels 0 2 4 6 and 1 3 5 7, four bytes each.
  const __m256i mixed = _mm256_packus_epi16(_mm256_packus_epi32(code(light[0]), code(light[1])),
                                            _mm256_packus_epi32(code(light[2]), code(light[3])));
  const __m256i ordered =
      _mm256_permutevar8x32_epi32(mixed, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7));
  const __m256i dense = _mm256_shuffle_epi8(
      ordered, _mm256_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1,  //
                                0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1));
  static_assert(sizeof(Rgb8) == 3);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(first), _mm256_castsi256_si128(dense));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(second), _mm256_extracti128_si256(dense, 1));
}

}  // namespace mh
