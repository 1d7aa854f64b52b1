// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "slam/core/random.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Standard normal numbers over views: smooth in the camera's position (m) and viewing direction,
/// independent beyond about 1 m or 30 degrees, identical for identical views. Value noise: normal
/// numbers at the corners of a lattice in the six coordinates, interpolated and rescaled to a
/// variance of one.
class ViewNoise {
 public:
  explicit ViewNoise(const SE3& world_from_camera);
  double normal(RandomStream stream) const;

 private:
  static constexpr std::size_t kCorners = 64;
  std::array<std::uint64_t, kCorners> corner_;  // hashes of lattice points
  std::array<double, kCorners> weight_;         // sum of squares is 1
};

/// P(X < x) of a standard normal X.
double normal_cdf(double x);

}  // namespace mh
