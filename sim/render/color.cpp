// SPDX-License-Identifier: Apache-2.0
#include "sim/render/color.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace mh
