// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/motion/motion.hpp"

namespace mh {

/// How the base should move on a stretch of a tour: poses one step apart, from rest to rest.
struct Stretch {
  std::vector<Eigen::Vector2d> position_m;
  std::vector<double> heading_rad;    ///< unwrapped: includes full turns
  std::vector<std::size_t> waypoint;  ///< index of the waypoint that the base heads for
};

/// Returns the moving average over the shortest window that respects the jerk limits; position and
/// heading each have their own window, with the same delay. Averaging an acceleration a(t) over a
/// time T gives the jerk (a(t + T/2) - a(t - T/2)) / T: if |a| <= A, some T of at most 2 A / jerk
/// suffices. The peaks of velocity and acceleration do not increase, and no position moves by more
/// than A T^2 / 24. Returns the stretch unchanged if jerk is not limited.
Stretch smoothed(const Stretch& stretch, const BaseLimits& limits, double step_s);

/// Returns the motion that a tour prescribes: velocity, acceleration and jerk, as differences of
/// neighboring poses, stay within the limits. The base stops at the end of each stretch.
/// @param differential  wheels of a differential base, else null. A differential base drives with
///                      its middle through the waypoints and always faces its direction of travel:
///                      it turns to a heading only where it stops, and never looks to the side.
/// @pre the tour has waypoints
std::vector<Stretch> reference_motion(const Tour& tour, const BaseLimits& limits, double step_s,
                                      const WheelBase* differential = nullptr);

// What both kinds of bases share.

/// Waypoints `first` to `last`, driven without a stop before the last.
struct TourRun {
  std::size_t first, last;
  std::vector<Eigen::Vector2d> corners_m;  ///< starting with the place before `first`
};
/// @param turns_at_stops  a waypoint with a heading is a stop
std::vector<TourRun> runs_of(const Tour& tour, bool turns_at_stops);
/// Legs shorter than this are not driven.
inline constexpr double kNoWay_m = 0.01;
/// The limits minus the reserve for the controller that keeps the base on its reference.
BaseLimits planned_limits(BaseLimits limits);
/// Angles of a turn in place at each step until it is at rest; the turn accelerates up to the turn
/// rate and slows back down.
std::vector<double> turn_profile(double angle_rad, const BaseLimits& limits, double step_s);

}  // namespace mh
