// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "robots/model/robot.hpp"
#include "robots/model/wheel_base.hpp"
#include "slam/core/random.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// Simulates wheel odometry, one motion after another. Between two poses each rim turns as far as
/// the true motion (a constant twist) requires; the reading is that distance times (1 + scale),
/// times (1 + scale_spread * normal) of this wheel, plus slip: a normal error of variance
/// slip_per_sqrt_m^2 times the distance. The poses are integrated from the readings. So the drift
/// of a straight drive of length L is scale * L along it on average, and its random part grows with
/// the square root of L, as in Martinelli, "The odometry error of a mobile robot with a synchronous
/// drive system", ICRA 2002.
class WheelOdometer {
 public:
  WheelOdometer(const WheelBase& wheels, const OdometryErrors& errors, std::uint64_t seed);

  /// Drives to the next pose. @returns odom_from_base, initially world_from_base itself
  const SE3& drive_to(const SE3& world_from_base);
  /// The base was lifted to another pose: its wheels did not turn.
  void lift_to(const SE3& world_from_base) { before_ = world_from_base; }

 private:
  WheelBase wheels_;
  OdometryErrors errors_;
  RandomStream stream_;
  PerWheel scale_;
  std::optional<SE3> before_;
  SE3 odom_from_base_;
  std::uint64_t step_ = 0;
};

/// Simulates wheel odometry along a whole path.
/// @param base  world_from_base
/// @returns odom_from_base at the same stamps; the first pose is that of `base`
Trajectory wheel_odometry(const Trajectory& base, const WheelBase& wheels,
                          const OdometryErrors& errors, std::uint64_t seed);

}  // namespace mh
