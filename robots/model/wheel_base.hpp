// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <Eigen/Core>

#include "robots/model/robot.hpp"

namespace mh {

/// Velocity of a base in its own frame: x ahead, y to the left, turn counter-clockwise.
using Twist2d = Eigen::Vector3d;  ///< m/s, m/s, rad/s

/// The rim speed of each wheel (m/s) for a motion of the base. A wheel drives along the floor at
/// right angles to its axle and rolls freely along it.
Eigen::Vector3d rim_speeds_m_per_s(const OmniWheels& wheels, const Twist2d& twist);
/// The motion that results from these rim speeds; the inverse of the above.
Twist2d twist_of_rims(const OmniWheels& wheels, const Eigen::Vector3d& rims_m_per_s);
/// Follows a velocity command within limits of velocity, acceleration and jerk, with the base's
/// motion over the floor (world frame) and its rotation treated independently. Each step changes
/// the acceleration by at most jerk * step, toward the largest one that can still be reduced to
/// zero by the time the command is reached.
///
/// With wheels, no rim exceeds its limit: speed + reach * turn rate stays within the rims' limit,
/// where reach is that of the outermost wheel. This is slightly conservative (a rim sees only a
/// part of the speed), and is valid while base and rotation follow independently.
class JerkLimiter {
 public:
  JerkLimiter(const BaseLimits& limits, double step_s, const OmniWheels* wheels = nullptr);

  /// The velocity to have after the next step.
  struct Velocity {
    Eigen::Vector2d m_per_s = Eigen::Vector2d::Zero();  ///< world
    double turn_rad_per_s = 0;
  };
  Velocity step(const Velocity& command);
  /// Something else changed the velocity: continues from there, without acceleration.
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
