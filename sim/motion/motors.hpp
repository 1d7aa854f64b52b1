// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "robots/model/wheel_base.hpp"
#include "sim/physics/planar_world.hpp"

namespace mh {

/// Converts between the base's velocity over the floor and that of its motors
/// (JerkLimiter::Velocity): for an omnidirectional base they are the same; for a differential one,
/// the velocity of the motors is the forward speed of the base's middle.
class Motors {
 public:
  /// @param differential  its wheels, which must outlive this; null for an omnidirectional base
  explicit Motors(const WheelBase* differential) : differential_(differential) {}

  /// The motors' velocity for a commanded velocity over the floor (world).
  JerkLimiter::Velocity commanded(const Eigen::Vector2d& m_per_s, double turn_rad_per_s,
                                  double heading_rad) const {
    if (differential_ == nullptr) return {.m_per_s = m_per_s, .turn_rad_per_s = turn_rad_per_s};
    const Eigen::Vector2d in_base = Eigen::Rotation2Dd(-heading_rad) * m_per_s;
    return {.m_per_s = {ahead_of(*differential_, {in_base.x(), in_base.y(), turn_rad_per_s}), 0},
            .turn_rad_per_s = turn_rad_per_s};
  }
  /// The motors' velocity for the base's actual motion.
  JerkLimiter::Velocity measured(const BaseState& state) const {
    return commanded(state.velocity_m_per_s, state.turn_rad_per_s, state.heading_rad);
  }
  /// The base's mean velocity during a step that begins at this heading.
  BaseCommand over_floor(const JerkLimiter::Velocity& motors, double heading_rad,
                         double step_s) const {
    const double turn = motors.turn_rad_per_s;
    if (differential_ == nullptr)
      return {.velocity_m_per_s = motors.m_per_s, .turn_rad_per_s = turn};
    const Twist2d twist = twist_of(*differential_, motors.m_per_s.x(), turn);
    return {
        .velocity_m_per_s = Eigen::Rotation2Dd(heading_rad + 0.5 * turn * step_s) * twist.head<2>(),
        .turn_rad_per_s = turn};
  }

 private:
  const WheelBase* differential_;
};

}  // namespace mh
