// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "robots/model/robot.hpp"
#include "scenes/recordings/messages/message_log.hpp"
#include "scenes/scene.hpp"
#include "sim/motion/floor_grid.hpp"
#include "sim/motion/motion.hpp"
#include "sim/motion/sensing.hpp"

namespace mh {

/// A drive and what the robot measured on it, as input of robot_messages().
struct DriveRecord {
  const Robot& robot;
  const DrivenPath& path;                 ///< path that the robot drove
  const Trajectory& camera;               ///< world_from_camera, stamps of the path
  std::optional<RobotReadings> readings;  ///< only for a robot with equipment
  std::optional<FloorGrid> grid;          ///< grid of the level scene
  SE3 world_from_level;                   ///< from the frame of the readings and the grid
};

/// Collects what belongs to a drive: sensor readings of a robot that has equipment, and the floor
/// as a grid, if it can be made.
/// @param others  moving obstacles during the drive
DriveRecord record_drive(const Scene& scene, const Robot& robot, const DrivenPath& path,
                         const Trajectory& camera, std::uint64_t seed,
                         const std::vector<MovingObstacle>& others);

/// What a robot's messages tell of one moment.
struct RobotMoment {
  Stamp stamp_ns = 0;
  SE3 world_from_base, world_from_camera;
  std::optional<SE3> odom_from_base = {};  ///< if it has wheel odometry
  const RobotReading* reading = nullptr;   ///< null if it has no equipment
};

/// Turns moments into the messages of a robot: tf (map, odom, base_footprint, base_link,
/// camera_link, camera_optical_frame and the sensors' frames), the true pose of its base, and the
/// readings of those sensors that it has (odometry, laser scans, sonars, bumpers, IMU).
class RobotMessages {
 public:
  /// @param log         receives the topics now and the messages later; it must outlive this
  /// @param head_moves  whether the camera moves on the base
  RobotMessages(MessageLog& log, const Robot& robot, bool has_odometry, bool has_readings,
                bool head_moves);

  void add(const RobotMoment& moment);
  /// Adds the floor's grid, once.
  void add_grid(const FloorGrid& grid, const SE3& world_from_level, Stamp stamp_ns);

 private:
  void add_fixed(const RobotMoment& moment);
  void add_odometry(const RobotMoment& moment);
  void add_reading(const RobotMoment& moment);
  ros::Header header(const RobotMoment& moment, const std::string& frame) const {
    return {count_, {moment.stamp_ns}, frame};
  }

  MessageLog& log_;
  const Robot& robot_;
  bool has_odometry_, head_moves_;
  std::uint32_t count_ = 0;  ///< moments until now
  std::optional<RobotMoment> before_;
  std::size_t tf_ = 0, tf_static_ = 0, truth_ = 0, odometry_ = 0, imu_ = 0;
  std::vector<std::size_t> lasers_, sonars_, bumpers_;  ///< topics, in the robot's order
};

/// The messages of a whole drive, sorted by stamp, with the floor's grid.
MessageLog robot_messages(ros::Wire wire, const DriveRecord& drive);

}  // namespace mh
