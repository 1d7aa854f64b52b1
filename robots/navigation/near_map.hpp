// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "robots/model/robot.hpp"
#include "robots/navigation/grid.hpp"
#include "robots/navigation/pose2.hpp"
#include "slam/core/camera.hpp"

namespace mh {

struct NearMapConfig {
  double resolution_m = 0.05;
  double half_size_m = 5.0;  ///< half the side of the window that moves along with the robot
  // What the depth camera shows between these heights is an obstacle. The lower one, 8 cm, is above
  // the depth noise of a floor at max_depth_m, seen from 1.1 m.
  double bottom_m = 0.08, top_m = 1.25;
  double max_depth_m = 3.5;
  /// Nearer than this, the camera looks over things lower than itself, so nothing is cleared there.
  double blind_m = 1.2;
};

/// What lasers, bumpers and the depth camera have recently shown around the robot, in the frame of
/// the wheel odometry: it needs neither a map nor a pose in one. An obstacle is kept until the same
/// kind of sensor sees through it.
class NearMap {
 public:
  explicit NearMap(const NearMapConfig& config = {});

  /// Forgets everything: the robot was carried.
  void clear();
  /// Adds the scans of all lasers. @param lasers_m as in RobotReading
  void add_lasers(const Equipment& equipment, std::span<const std::vector<float>> lasers_m,
                  const Pose2& odom_from_base);
  /// Adds a depth image taken at that pose. Pixels without a return are ignored.
  void add_depth(const Grid2d<float>& depth_m, const Camera& camera, const SE3& base_from_camera,
                 const Pose2& odom_from_base);
  /// Something was touched there.
  void add_contact(const Eigen::Vector2d& place_in_odom_m);

  /// Obstacles (odometry frame) within a radius of a place.
  std::vector<Eigen::Vector2d> obstacles_near(const Eigen::Vector2d& place_m,
                                              double radius_m) const;
  /// The window as a grid to plan on; what was never seen is blocked.
  FloorGrid grid() const;

 private:
  enum Layer : std::uint8_t { kLaser = 1, kDepth = 2, kTouched = 4, kSeen = 8 };
  std::uint8_t* cell(const Eigen::Vector2d& place_m);
  Eigen::Vector2d center_of(int x, int y) const;
  void move_to(const Eigen::Vector2d& place_m);
  /// Clears a layer along a ray, between from_m and to_m, and marks those cells as seen.
  void see_through(const Eigen::Vector2d& start_m, const Eigen::Vector2d& direction, double from_m,
                   double to_m, Layer layer);

  NearMapConfig config_;
  int cells_;                     ///< cells per side of the window
  Eigen::Vector2i corner_{0, 0};  ///< cell of the odometry frame that is cell (0, 0) of the window
  Grid2d<std::uint8_t> layers_;
};

}  // namespace mh
