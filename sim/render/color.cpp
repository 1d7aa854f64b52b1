// SPDX-License-Identifier: Apache-2.0
#include "sim/render/color.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/render/simd.hpp"

namespace mh {
namespace {

std::array<float, 256> make_decode_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double s = i / 255.0;
    table[static_cast<std::size_t>(i)] =
        static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
  }
  return table;
}

std::array<std::uint8_t, kSrgbTableMax + 4> make_encode_table() {
  std::array<std::uint8_t, kSrgbTableMax + 4> table{};
  for (int i = 0; i <= kSrgbTableMax; ++i) {
    const double l = static_cast<double>(i) / kSrgbTableMax;
    const double s = l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1.0 / 2.4) - 0.055;
    table[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255.0 * s));
  }
  return table;
}

const std::array<float, 256> kDecode = make_decode_table();

using DecodeTable = std::array<float, 256>;

/// Calls use_eight(channel, values) with the table's values for eight channels at a time, then
/// use_one(channel, value) for the last few.
template <class UseEight, class UseOne>
void for_decoded(std::span<const Rgb8> row, const DecodeTable& table, const UseEight& use_eight,
                 const UseOne& use_one) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(row.data());
  const std::size_t count = 3 * row.size();
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    const __m256i codes =
        _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes + i)));
    use_eight(i, _mm256_i32gather_ps(table.data(), codes, sizeof(float)));
  }
  for (; i < count; ++i) use_one(i, table[bytes[i]]);
}

}  // namespace

const std::array<std::uint8_t, kSrgbTableMax + 4> kSrgbTable = make_encode_table();

float srgb_to_linear(std::uint8_t value) {
  return kDecode[value];
}

Eigen::Vector3f srgb_to_linear(Rgb8 color) {
  return {kDecode[color.r], kDecode[color.g], kDecode[color.b]};
}

std::uint8_t linear_to_srgb(float linear) {
  const float clamped = std::clamp(linear, 0.0F, 1.0F);
  return kSrgbTable[static_cast<std::size_t>(clamped * kSrgbTableMax + 0.5F)];
}

void add_linear(std::span<const Rgb8> row, float weight, float* sum) {
  DecodeTable weighted;
  for (std::size_t i = 0; i < weighted.size(); ++i) weighted[i] = weight * kDecode[i];
  for_decoded(
      row, weighted,
      [&](std::size_t i, __m256 eight) {
        _mm256_storeu_ps(sum + i, _mm256_add_ps(_mm256_loadu_ps(sum + i), eight));
      },
      [&](std::size_t i, float one) { sum[i] += one; });
}

void decode_row(std::span<const Rgb8> row, float* linear) {
  for_decoded(
      row, kDecode, [&](std::size_t i, __m256 eight) { _mm256_storeu_ps(linear + i, eight); },
      [&](std::size_t i, float one) { linear[i] = one; });
}

void encode_row(const float* linear, std::span<Rgb8> row) {
  const auto* table = reinterpret_cast<const int*>(kSrgbTable.data());
  auto* bytes = reinterpret_cast<std::uint8_t*>(row.data());
  const std::size_t count = 3 * row.size();
  const auto code = [&](std::size_t i) {
    const Float8 level = clamp8(load8(linear + i), 0.0F, 1.0F) * kSrgbTableMax + 0.5F;
    return _mm256_and_si256(_mm256_i32gather_epi32(table, (__m256i)to_int(level), 1),
                            _mm256_set1_epi32(0xFF));
  };
  std::size_t i = 0;
  for (; i + 32 <= count; i += 32) {
    const __m256i mixed = _mm256_packus_epi16(_mm256_packus_epi32(code(i), code(i + 8)),
                                              _mm256_packus_epi32(code(i + 16), code(i + 24)));
    const __m256i ordered =
        _mm256_permutevar8x32_epi32(mixed, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(bytes + i), ordered);
  }
  for (; i < count; ++i) bytes[i] = linear_to_srgb(linear[i]);
}

}  // namespace mh
