// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include <Eigen/Core>

#include "robots/model/robot.hpp"

namespace mh {

/// Velocity of a base in its own frame: x ahead, y to the left, turn counter-clockwise.
using Twist2d = Eigen::Vector3d;  ///< m/s, m/s, rad/s

inline constexpr std::size_t kMostWheels = 8;
/// One number per wheel.
using PerWheel = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostWheels, 1>;

/// Finds from the places and axles of the wheels how the base moves: sets kind and middle.
/// @returns "", or why no base can drive on these wheels
std::string find_kind(WheelBase& wheels);

/// The rim speed of each wheel (m/s) for a motion of the base. A wheel drives along the floor
/// perpendicular to its axle; along the axle, it rolls freely (omnidirectional base) or slips
/// (differential base). Speeds are positive when a differential base drives ahead; for an
/// omnidirectional one, when wheels turn about their axles in the positive direction.
PerWheel rim_speeds_m_per_s(const WheelBase& wheels, const Twist2d& twist);
/// The motion that results from these rim speeds; the inverse of the above. A differential base
/// drives ahead at the mean of both sides, v = (right + left) / 2, and turns at their difference
/// divided by the track, (right - left) / b, about the middle of its wheels; with more than two
/// wheels, the result is the least-squares fit.
Twist2d twist_of_rims(const WheelBase& wheels, const PerWheel& rims_m_per_s);

/// The twist of a differential base's origin when its middle drives ahead and the base turns. The
/// origin swings sideways unless it is the middle.
Twist2d twist_of(const WheelBase& differential, double ahead_m_per_s, double turn_rad_per_s);
/// How fast the middle drives ahead in a motion of the base. The inverse of twist_of().
double ahead_of(const WheelBase& differential, const Twist2d& twist);

/// Follows a velocity command within limits of velocity, acceleration and jerk, with the base's
/// motion over the floor (world frame) and its rotation treated independently. Each step changes
/// the acceleration by at most jerk * step, toward the largest one that can still be reduced to
/// zero by the time the command is reached.
///
/// With wheels, no rim exceeds its limit: speed + reach * turn rate stays within the rims' limit,
/// where reach is the outermost wheel's distance from the middle. This is slightly conservative for
/// an omnidirectional base (a rim sees only a part of the speed), and holds although translation
/// and rotation follow independently. For a differential base, the first component of the velocity
/// is its speed ahead, the second 0.
class JerkLimiter {
 public:
  JerkLimiter(const BaseLimits& limits, double step_s, const WheelBase* wheels = nullptr);

  /// The velocity to have after the next step.
  struct Velocity {
    Eigen::Vector2d m_per_s = Eigen::Vector2d::Zero();  ///< world frame; differential base: its own
    double turn_rad_per_s = 0;
  };
  Velocity step(const Velocity& command);
  /// Continues from this velocity, which something else caused, without acceleration.
  void stopped_at(const Velocity& velocity);

 private:
  BaseLimits limits_;
  double step_s_;
  double most_m_per_s_ = std::numeric_limits<double>::infinity();  ///< of speed + reach * turn rate
  double reach_m_ = 0;
  Velocity velocity_;
  Eigen::Vector2d acceleration_m_per_s2_ = Eigen::Vector2d::Zero();
  double turn_acceleration_rad_per_s2_ = 0;
};

}  // namespace mh
