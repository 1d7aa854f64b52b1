// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sim/motion/motion.hpp"
#include "sim/physics/planar_world.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// Readings of a robot's own sensors at one time. Lasers and sonars measure everything between 3 cm
/// and the top of the robot's head, exactly, apart from range, resolution and the lasers' noise.
struct RobotReading {
  Stamp stamp_ns = 0;
  std::vector<std::vector<float>> lasers_m;  ///< by laser, right to left; 0 = nothing in range
  std::vector<float> sonars_m;               ///< by sonar; 0 = nothing in range
  std::vector<bool> bumpers;                 ///< by bumper: pressed
  /// Specific force (accelerometer) and angular rate (gyroscope), IMU frame: the exact mean over
  /// the time between two frames. Without an IMU: 0.
  Eigen::Vector3d specific_force_m_per_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_rad_per_s = Eigen::Vector3d::Zero();
};

struct RobotReadings {
  Trajectory odometry;  ///< odom_from_base (see wheel_odometry); empty without wheels
  std::vector<RobotReading> moments;
};

/// @throws InputError if the robot has no lasers
const Equipment& equipment_with_lasers(const Robot& robot);
/// The noise of a robot's lasers.
/// @param tick  number of camera ticks since the drive began
RandomStream laser_noise(std::uint64_t seed, std::size_t tick);
/// What the lasers measure, by laser and ray, m; 0 = nothing in range.
/// @param noise  random stream for these scans
std::vector<std::vector<float>> read_lasers(const PlanarWorld& world, const Equipment& equipment,
                                            const SE3& world_from_base, RandomStream noise);
/// Reads lasers and sonars in the world as it is now; the rest of the reading is left empty.
RobotReading read_ranges(const PlanarWorld& world, const Equipment& equipment,
                         const SE3& world_from_base, RandomStream noise);
/// Which bumpers a contact presses, by bumper.
std::vector<bool> pressed_bumpers(const Contact& contact, const Equipment& equipment,
                                  const SE3& world_from_base);
/// Fills in the IMU's readings; the specific force is from the second difference of the IMU's
/// position. The poses are those of the base.
void feel(RobotReading& reading, const TimedPose& before, const TimedPose& here,
          const TimedPose& after, const SE3& base_from_imu);

/// Simulates the robot's sensors along the path of its base.
/// @param others  moving obstacles during the drive
/// @throws InputError if the robot has no equipment.
RobotReadings read_sensors(const Scene& scene, const Robot& robot, const Trajectory& base,
                           std::uint64_t seed, const std::vector<MovingObstacle>& others = {});

}  // namespace mh
