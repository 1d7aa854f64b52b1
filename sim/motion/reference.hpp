// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/motion/motion.hpp"

namespace mh {

/// How the base should move on a stretch of a tour: poses one step apart, from rest to rest.
struct Stretch {
  std::vector<Eigen::Vector2d> position_m;
  std::vector<double> heading_rad;    ///< unwrapped: includes full turns
  std::vector<std::size_t> waypoint;  ///< index of the one that it is heading for
};

/// Returns the moving average over the shortest window that respects the jerk limits; position and
/// heading each have their own window, with the same delay. Averaging an acceleration a(t) over a
/// time T gives the jerk (a(t + T/2) - a(t - T/2)) / T: with |a| <= A there is such a T, at most 2
/// A / jerk. Velocity and acceleration increase nowhere, and no position moves by more than A T^2 /
/// 24. Returns the stretch unchanged if jerk is not limited.
Stretch smoothed(const Stretch& stretch, const BaseLimits& limits, double step_s);

/// Returns the motion that a tour prescribes: velocity, acceleration and jerk, as differences of
/// neighboring poses, stay within the limits. The base stops at the end of each stretch.
/// @pre the tour has waypoints
std::vector<Stretch> reference_motion(const Tour& tour, const BaseLimits& limits, double step_s);

}  // namespace mh
