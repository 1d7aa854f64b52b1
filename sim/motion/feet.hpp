// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sim/motion/floor_grid.hpp"
#include "sim/motion/handheld_scan.hpp"
#include "slam/core/random.hpp"

namespace mh::handheld {

inline constexpr double kHead_m = 1.9;  ///< anything that hangs higher is not in the way

/// Where a person can walk, with as much clearance as the place allows.
struct Ground {
  FloorGrid floor;  ///< between foot and head
  FloorGrid eyes;   ///< at the camera's height: what blocks the view
  Grid2d<std::uint8_t> region;
  double clearance_m = 0;
  double area_m2 = 0;
};

/// @param height_m  height of the camera
/// @throws InputError if there is no floor, or no space on it for a person
Ground ground_of(const Scene& scene, double height_m);

/// Position and speed of the feet in each frame.
struct Feet {
  std::vector<Eigen::Vector2d> at_m;
  std::vector<double> speed_m_per_s;
};
/// @param bouts   random stream for the lengths and speeds of the bouts of walking
/// @param places  seed for the visited places
Feet feet_on(const Ground& ground, const HandheldConfig& config, std::size_t frames, double rate_hz,
             RandomStream bouts, std::uint64_t places);

}  // namespace mh::handheld
