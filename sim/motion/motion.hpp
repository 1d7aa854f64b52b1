// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "sim/physics/planar_world.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// One leg of a tour: drive to a place, turn in place there, pause there. A waypoint with neither
/// turn nor pause is passed without stopping; its corner is rounded by an arc (PathConfig::cut_m).
struct Waypoint {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  // Where the base faces while driving: toward look_at_m, if given; else it turns along the leg to
  // reach heading_rad at arrival, if given; else it faces the direction of travel.
  std::optional<double> heading_rad = {};
  std::optional<Eigen::Vector2d> look_at_m = {};
  double turn_rad = 0.0;  ///< turned in place at arrival, counter-clockwise; may exceed a full turn
  double pause_s = 0.0;   ///< rest after the turn
  int line = 0;           ///< in the tour's file, for messages; 0 = none
};

struct Tour {
  std::string name;
  std::filesystem::path file;  ///< its source, for messages
  Eigen::Vector2d start_m = Eigen::Vector2d::Zero();
  double start_heading_rad = 0.0;
  int start_line = 0;  ///< in the file, for messages; 0 = none
  // Limits of the tour itself; they can lower the robot's own limits, but not raise them.
  std::optional<double> max_velocity_m_per_s;
  std::optional<double> max_turn_rad_per_s;
  bool plan = false;  ///< paths over the free floor between waypoints instead of straight lines
  std::vector<Waypoint> waypoints;
};

/// Reads a tour (YAML): `name`; `start: {position: [x, y], heading_deg}`; optional `speed_m_per_s`,
/// `turn_deg_per_s`, `plan` (true or false); `waypoints`, a list of mappings with any of `to: [x,
/// y]`, `heading_deg`, `face: travel | [x, y]`, `turn_deg`, `pause_s`. Without `to` the robot stays
/// in place.
/// @throws InputError naming file, line, field and value.
Tour load_tour(const std::filesystem::path& file);

/// Peak motion of the base between consecutive physics steps, excluding contacts; translation and
/// rotation.
struct DrivePeaks {
  double m_per_s = 0, m_per_s2 = 0, m_per_s3 = 0;
  double rad_per_s = 0, rad_per_s2 = 0, rad_per_s3 = 0;
  double rim_m_per_s = 0;  ///< rim speed of any wheel, if the robot has wheels
};

/// The robot's actual motion: base and camera, at the camera's rate.
struct DrivenPath {
  std::vector<TimedPose> camera;            ///< world_from_camera, stamps of frames
  std::vector<TimedPose> base;              ///< world_from_base, same stamps
  std::vector<std::array<double, 2>> head;  ///< yaw, pitch (rad), same stamps; empty = at rest
  double length_m = 0.0;
  double turned_in_place_rad = 0.0;
  double max_penetration_m = 0.0;
  double contact_time_s = 0.0;  ///< time spent touching something
  DrivePeaks peaks;             ///< all 0 if the camera was not moved by physics
  /// How the poses of a file were moved, for the user; empty if they were not moved or come from no
  /// file.
  std::string moved = {};
};

/// Drives the robot through the scene with Bullet, along the reference_motion of the tour, limited
/// in velocity, acceleration and (if the robot has such a limit) jerk, and samples the camera.
/// Stamps are round(i * 1e9 / rate). The base comes from Bullet's body, the camera from the base
/// and base_from_camera; nothing is added. Paths are planned first if the tour requests that.
/// @param others  moving obstacles; one that runs into the robot pushes it; a tour does not wait
///                for obstacles
/// @throws InputError naming tour, waypoint, place and the obstacle if a waypoint is not reached,
/// or if the start pose is inside something or outside the rooms.
DrivenPath drive(const Scene& scene, const Robot& robot, const Tour& tour,
                 const std::vector<MovingObstacle>& others = {});

}  // namespace mh
