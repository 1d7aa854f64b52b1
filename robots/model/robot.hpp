// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "robots/model/urdf.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Limits of a holonomic base.
struct BaseLimits {
  double max_velocity_m_per_s = 0.35;
  double max_acceleration_m_per_s2 = 0.3;
  double max_turn_rad_per_s = 1.0;
  double max_turn_acceleration_rad_per_s2 = 0.75;
  // Unset: not limited.
  std::optional<double> max_jerk_m_per_s3 = {}, max_turn_jerk_rad_per_s3 = {};
};

/// Three wheels that drive along the floor and roll freely along their axles.
struct OmniWheels {
  struct Wheel {
    std::string joint;
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< its position, base frame
    double axle_rad = 0;                                ///< direction of its axle from base x
  };
  std::array<Wheel, 3> wheels;
  double radius_m = 0.07;
  double max_rim_m_per_s = 0.44;  ///< the joints' velocity limit times the radius
};

/// Errors of wheel odometry. See odometry.hpp.
struct OdometryErrors {
  double scale = 0.0;            ///< of all wheels' radius: 0.01 = 1 % too long
  double scale_spread = 0.0;     ///< of each wheel's, a normal draw per seed
  double slip_per_sqrt_m = 0.0;  ///< m of error after 1 m of rim, growing with its root
};

/// A fan of rays in a plane.
struct LaserScanner {
  std::string name;
  SE3 base_from_laser;  ///< rays leave along x, turned about z
  int rays = 15;
  double field_of_view_rad = 1.0472;
  double min_range_m = 0.1, max_range_m = 3.0;
};

/// A cone; measures the nearest object in it.
struct Sonar {
  std::string name;
  SE3 base_from_sonar;  ///< it looks along x
  double field_of_view_rad = 0.5236;
  double min_range_m = 0.25, max_range_m = 2.55;
  double resolution_m = 0.03;
};

/// Where the external-collision reflex stops the robot: if an obstacle is closer, it drives no
/// farther in that direction.
struct CollisionReflex {
  double ahead_m = 0.40;  ///< from the shell, in the direction of travel
  double aside_m = 0.10;  ///< to either side of that path
};

struct MountedCamera {
  std::string name, link;
  Camera camera = {};
};

/// Equipment other than base and camera, for a robot with a URDF.
struct Equipment {
  KinematicTree tree;
  OmniWheels wheels;
  std::string head_yaw, head_pitch;  ///< names of joints
  std::string depth_camera_link;     ///< which the camera of Robot is mounted on
  std::vector<MountedCamera> cameras;
  std::vector<std::string> bumpers;  ///< links where the shell makes contact first
  std::vector<LaserScanner> lasers;
  std::vector<Sonar> sonars;
  SE3 base_from_imu;
  OdometryErrors odometry;
  CollisionReflex reflex;
};

/// A robot as the simulator needs it. Base frame: on the floor, x forward, z up.
struct Robot {
  std::string name;
  double mass_kg = 0.0;
  double footprint_radius_m = 0.26;
  double height_m = 1.21;
  BaseLimits limits;
  Camera camera;                               ///< the RGB-D camera
  SE3 base_from_camera;                        ///< optical frame: x right, y down, z forward
  std::shared_ptr<const Equipment> equipment;  ///< null if the file names no URDF
};

/// Reads robots/<name>/<name>.yaml. @throws InputError naming file, line, field and value.
Robot load_robot(const std::filesystem::path& file);

}  // namespace mh
