// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Linear light in [0, 1] of an 8-bit sRGB value; IEC 61966-2-1.
float srgb_to_linear(std::uint8_t value);
Eigen::Vector3f srgb_to_linear(Rgb8 color);

/// The nearest 8-bit sRGB value of a linear one, clamped to [0, 1]; from a table of 2^14 entries,
/// whose steps are below 1/4 of a gray level.
std::uint8_t linear_to_srgb(float linear);

// The same for rows, eight values at a time.

/// Adds weight * srgb_to_linear() of each channel to sum[0 ... 3 row.size()).
void add_linear(std::span<const Rgb8> row, float weight, float* sum);
/// srgb_to_linear() of each channel.
void decode_row(std::span<const Rgb8> row, float* linear);
/// linear_to_srgb() of each channel of `linear`.
void encode_row(const float* linear, std::span<Rgb8> row);

/// The table behind linear_to_srgb: entry i is for the linear value i / kSrgbTableMax. Four bytes
/// can be read starting at any entry.
inline constexpr int kSrgbTableMax = 16383;
extern const std::array<std::uint8_t, kSrgbTableMax + 4> kSrgbTable;

/// Relative luminance of linear RGB; Rec. 709.
inline float luminance(const Eigen::Vector3f& linear) {
  return 0.2126F * linear.x() + 0.7152F * linear.y() + 0.0722F * linear.z();
}

}  // namespace mh
