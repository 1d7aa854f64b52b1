// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Linear light in [0, 1] for an 8-bit sRGB level (IEC 61966-2-1).
inline float linear_from_srgb(std::uint8_t level) {
  const float v = static_cast<float>(level) / 255.0F;
  return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}

inline Eigen::Vector3f linear_from_srgb(Rgb8 c) {
  return {linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b)};
}

/// The nearest sRGB level for linear light, which is clamped to [0, 1].
inline std::uint8_t srgb_from_linear(float linear) {
  const float v = std::clamp(linear, 0.0F, 1.0F);
  const float s = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1.0F / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(s * 255.0F + 0.5F);
}

inline Rgb8 srgb_from_linear(const Eigen::Vector3f& linear) {
  return {srgb_from_linear(linear.x()), srgb_from_linear(linear.y()), srgb_from_linear(linear.z())};
}

}  // namespace mh
