// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <immintrin.h>

#include <array>

namespace mh {

/// Eight lanes of AVX2; arithmetic and comparisons use the compiler's operators. Nothing here is
/// contracted to fused operations, so that every build gives the same bits.
using Float8 = float __attribute__((vector_size(32)));
using Int8 = int __attribute__((vector_size(32)));

inline Float8 splat(float value) {
  return _mm256_set1_ps(value);
}
inline Int8 splat(int value) {
  return Int8{} + value;
}
inline Float8 load8(const float* from) {
  return _mm256_loadu_ps(from);
}
inline Int8 load8(const unsigned* from) {
  return (Int8)_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}
inline void store8(int* to, Int8 value) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), (__m256i)value);
}
inline void store8(unsigned* to, Int8 value) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), (__m256i)value);
}
inline Float8 floor8(Float8 value) {
  return _mm256_floor_ps(value);
}
inline Float8 clamp8(Float8 value, float low, float high) {
  return _mm256_min_ps(_mm256_max_ps(value, splat(low)), splat(high));
}
inline Float8 abs8(Float8 value) {
  return _mm256_andnot_ps(splat(-0.0F), value);
}
inline Float8 to_float(Int8 value) {
  return __builtin_convertvector(value, Float8);
}
/// Truncates toward zero.
inline Int8 to_int(Float8 value) {
  return __builtin_convertvector(value, Int8);
}

/// Whether a comparison holds in all lanes.
inline bool all8(Int8 comparison) {
  return _mm256_movemask_ps((__m256)comparison) == 0xFF;
}

/// Four fields, the same for all eight lanes.
inline std::array<Float8, 4> spread_fields(const float* from) {
  return {splat(from[0]), splat(from[1]), splat(from[2]), splat(from[3])};
}

/// Four fields of eight lanes, from 16 contiguous bytes per lane.
inline std::array<Float8, 4> load_fields(const std::array<const float*, 8>& from) {
  const auto pair = [&](std::size_t i) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(from[i])),
                                _mm_loadu_ps(from[i + 4]), 1);
  };
  const __m256 r0 = pair(0), r1 = pair(1), r2 = pair(2), r3 = pair(3);
  const __m256 a = _mm256_unpacklo_ps(r0, r1), b = _mm256_unpackhi_ps(r0, r1);
  const __m256 c = _mm256_unpacklo_ps(r2, r3), d = _mm256_unpackhi_ps(r2, r3);
  return {_mm256_shuffle_ps(a, c, 0x44), _mm256_shuffle_ps(a, c, 0xEE),
          _mm256_shuffle_ps(b, d, 0x44), _mm256_shuffle_ps(b, d, 0xEE)};
}

}  // namespace mh
