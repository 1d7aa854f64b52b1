// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "robots/model/wheel_base.hpp"
#include "robots/navigation/pose2.hpp"

namespace mh {

struct FollowConfig {
  double speed_m_per_s = 0.35;   ///< MaxVelXY's default (robots/pepper/pepper.yaml)
  double turn_rad_per_s = 0.6;   ///< lower than the base's limit: 3.4 degrees per frame at 10 Hz
  double ahead_m = 0.30;         ///< it steers toward the place this far along the path
  double braking = 0.4;          ///< share of the acceleration to brake with: jerk limits delay it
  double face_rad = 0.5;         ///< if its heading is farther off the path, it only turns
  double shell_margin_m = 0.04;  ///< extra distance of the shell from what the sensors show
  double arrived_m = 0.08;       ///< within this distance of the path's end
};

/// The highest speed in a direction at which the base can still stop before the nearest of some
/// places; infinite if none is in the way.
/// @param radius_m  radius of the disc that must not touch any of them
double speed_before(std::span<const Eigen::Vector2d> obstacles_m, const Eigen::Vector2d& place_m,
                    const Eigen::Vector2d& direction, double radius_m, double braking_m_per_s2);

/// Steering of a base along a path: pure pursuit (Coulter, 1992) of a place ahead, facing it,
/// slower before the end, in turns, and before what the sensors show. A differential base drives
/// only where it faces.
struct Steering {
  Twist2d command = Twist2d::Zero();
  double left_m = 0;     ///< length of the path that is left
  bool arrived = false;  ///< at the path's end
  bool blocked = false;  ///< an obstacle is in the way
};

/// @param path       in the frame of `at`; at least one place
/// @param at         pose of the base
/// @param obstacles  in the same frame as `path`
Steering follow(const std::vector<Eigen::Vector2d>& path, const Pose2& at,
                std::span<const Eigen::Vector2d> obstacles_m, const Robot& robot,
                const FollowConfig& config = {});

/// The command that turns in place toward a heading; 0 once within `close_rad`.
Twist2d turn_in_place(double left_rad, const BaseLimits& limits, const FollowConfig& config,
                      double close_rad = 0.03);

}  // namespace mh
