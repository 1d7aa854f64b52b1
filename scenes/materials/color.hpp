// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// An sRGB color in [0, 255] during mixing. Colors are mixed in sRGB, which is nearly uniform in
/// perception and keeps painters short.
struct Tint {
  float r = 0, g = 0, b = 0;

  constexpr Tint() = default;
  constexpr Tint(float red, float green, float blue) : r(red), g(green), b(blue) {}
  constexpr explicit Tint(Rgb8 c) : r(c.r), g(c.g), b(c.b) {}

  friend constexpr Tint operator+(Tint a, Tint c) { return {a.r + c.r, a.g + c.g, a.b + c.b}; }
  friend constexpr Tint operator*(Tint a, float s) { return {a.r * s, a.g * s, a.b * s}; }
};

constexpr Tint blend(Tint a, Tint b, float t) {
  return a * (1.0F - t) + b * t;
}

/// 0 below `low`, 1 above `high`, smooth between.
constexpr float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

constexpr Rgb8 to_rgb8(Tint c) {
  const auto level = [](float v) {
    return static_cast<std::uint8_t>(std::clamp(v + 0.5F, 0.0F, 255.0F));
  };
  return {level(c.r), level(c.g), level(c.b)};
}

}  // namespace mh
