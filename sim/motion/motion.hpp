// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// One leg of a tour: drive to (x, y), facing the given heading at arrival; or turn in place.
struct Waypoint {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  std::optional<double> heading_rad;  ///< none: face the way of travel
  double pause_s = 0.0;
};

struct Tour {
  std::string name;
  std::filesystem::path file;  ///< where it came from, for messages
  Eigen::Vector2d start_m = Eigen::Vector2d::Zero();
  double start_heading_rad = 0.0;
  std::vector<Waypoint> waypoints;
};

/// Reads a tour (YAML). @throws InputError naming file, line, field and value.
Tour load_tour(const std::filesystem::path& file);

/// What the robot really did: base and camera, at the camera's rate.
struct DrivenPath {
  std::vector<TimedPose> camera;         ///< world_from_camera, stamps of frames
  std::vector<TimedPose> base;           ///< world_from_base, same stamps
  double length_m = 0.0;
  double turned_in_place_rad = 0.0;
  double max_penetration_m = 0.0;
  double contact_time_s = 0.0;           ///< time spent touching something
};

/// Drives the robot through the scene with Bullet, velocity and acceleration limited, and samples
/// the camera. @throws InputError naming tour, waypoint and place if a waypoint is not reached or
/// the start pose is inside something.
DrivenPath drive(const Scene& scene, const Robot& robot, const Tour& tour);

}  // namespace mh
