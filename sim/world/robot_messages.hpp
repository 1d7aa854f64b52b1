// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

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

/// The messages of a robot: tf (map, odom, base_footprint, base_link, camera_link,
/// camera_optical_frame and the sensors' frames), the true pose of its base, the readings of those
/// sensors that it has (odometry, laser scans, sonars, bumpers, IMU), and the floor's grid. Sorted
/// by stamp.
MessageLog robot_messages(ros::Wire wire, const DriveRecord& drive);

}  // namespace mh
