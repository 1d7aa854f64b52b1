// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/motion/motion.hpp"

namespace mh {

/// How the base should move on a stretch of a tour: poses one step apart, from rest to rest.
struct Stretch {
  std::vector<Eigen::Vector2d> position_m;
  std::vector<double> heading_rad;    ///< not wrapped: counts whole rounds
  std::vector<std::size_t> waypoint;  ///< index of the one that it is on its way to
};

/// The moving average over the shortest window that keeps the limits of jerk, position and heading
/// each with its own window, both delayed by the same. Averaging over a time T makes of an
/// acceleration a(t) the jerk (a(t + T/2) - a(t - T/2)) / T: with |a| <= A there is such a T, at
/// most 2 A / jerk. Velocity and acceleration grow nowhere, and no place moves by more than
/// A T^2 / 24. The stretch as it is where nothing limits jerk.
Stretch smoothed(const Stretch& stretch, const BaseLimits& limits, double step_s);

/// The motion that a tour asks for: velocity, acceleration and jerk, as differences of neighboring
/// poses give them, stay within the limits. The base stops at the end of each stretch.
/// @pre the tour has waypoints
std::vector<Stretch> reference_motion(const Tour& tour, const BaseLimits& limits, double step_s);

}  // namespace mh
