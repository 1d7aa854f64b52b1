// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sim/motion/motion.hpp"
#include "sim/physics/planar_world.hpp"

namespace mh {

/// What a robot's own sensors read at one moment. Lasers and sonars see what lies between 3 cm and
/// the robot's head, exactly but for their range and resolution.
struct RobotReading {
  Stamp stamp_ns = 0;
  std::vector<std::vector<float>> lasers_m;  ///< by laser, right to left; 0 = nothing in range
  std::vector<float> sonars_m;               ///< by sonar; 0 = nothing in range
  std::vector<bool> bumpers;                 ///< by bumper: pressed
  /// What an accelerometer feels (specific force) and a gyroscope turns at, IMU frame: the mean
  /// over the time between two frames, exact.
  Eigen::Vector3d specific_force_m_per_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_rad_per_s = Eigen::Vector3d::Zero();
};

struct RobotReadings {
  Trajectory odometry;  ///< odom_from_base (see wheel_odometry)
  std::vector<RobotReading> moments;
};

/// Reads the robot's sensors along a path that its base took.
/// @param others  that moved about meanwhile
/// @throws InputError if the robot has no equipment.
RobotReadings read_sensors(const Scene& scene, const Robot& robot, const Trajectory& base,
                           std::uint64_t seed, const std::vector<MovingObstacle>& others = {});

}  // namespace mh
