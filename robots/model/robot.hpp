// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "robots/model/urdf.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Limits of a base. Those on velocity, acceleration and jerk apply in any direction for an
/// omnidirectional base; a differential one drives only forward and backward.
struct BaseLimits {
  double max_velocity_m_per_s = 0.35;
  double max_acceleration_m_per_s2 = 0.3;
  double max_turn_rad_per_s = 1.0;
  double max_turn_acceleration_rad_per_s2 = 0.75;
  // Unset: not limited.
  std::optional<double> max_jerk_m_per_s3 = {}, max_turn_jerk_rad_per_s3 = {};
};

/// The wheels that drive a base. See wheel_base.hpp.
struct WheelBase {
  struct Wheel {
    std::string joint;
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< its position, base frame
    double axle_rad = 0;                                ///< direction of its axle from base x
  };
  enum class Kind {
    kOmnidirectional,  ///< three wheels that roll freely along their axles
    kDifferential,     ///< wheels on parallel axles, as many on the left as on the right
  };
  Kind kind = Kind::kOmnidirectional;
  std::vector<Wheel> wheels = {};
  double radius_m = 0.07;
  /// The joints' velocity limit times the wheels' radius; infinite if the joints have no limit.
  double max_rim_m_per_s = std::numeric_limits<double>::infinity();
  /// The middle of the wheels, base frame. A differential base turns about it, and it never moves
  /// sideways.
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
};

/// Errors of wheel odometry. See odometry.hpp.
struct OdometryErrors {
  double scale = 0.0;            ///< common to all wheels: 0.01 = 1 % too long
  double scale_spread = 0.0;     ///< standard deviation between wheels, per seed
  double slip_per_sqrt_m = 0.0;  ///< m of error after 1 m of rim travel, growing with its root
};

/// A fan of rays in a plane.
struct LaserScanner {
  std::string name;
  SE3 base_from_laser;  ///< rays leave along x, turned about z
  int rays = 15;
  double field_of_view_rad = 1.0472;
  double min_range_m = 0.1, max_range_m = 3.0;
  double sigma_m = 0, sigma_share = 0;  ///< noise: the larger of m and a share of the range

  /// Direction of a ray about z, from x.
  double angle_rad(std::size_t ray) const {
    return field_of_view_rad *
           (static_cast<double>(ray) / static_cast<double>(rays > 1 ? rays - 1 : 1) - 0.5);
  }
};

/// A cone; measures the nearest object in it.
struct Sonar {
  std::string name;
  SE3 base_from_sonar;  ///< it looks along x
  double field_of_view_rad = 0.5236;
  double min_range_m = 0.25, max_range_m = 2.55;
  double resolution_m = 0.03;
};

/// Distances of the external-collision reflex: the robot drives no farther toward an obstacle that
/// is closer.
struct CollisionReflex {
  double ahead_m = 0.40;  ///< from the shell, in the direction of travel
  double aside_m = 0.10;  ///< to either side of that path
};

struct MountedCamera {
  std::string name, link;
  Camera camera = {};
};

/// Joints that move the head, by name.
struct HeadJoints {
  std::string yaw, pitch;
};

/// Equipment other than base and camera, for a robot with a URDF. Each part is optional.
struct Equipment {
  KinematicTree tree;
  SE3 base_from_root;                    ///< the root of the tree of links
  std::optional<WheelBase> wheels = {};  ///< none: omnidirectional, no odometry
  std::optional<HeadJoints> head = {};
  std::string depth_camera_link;  ///< where Robot::camera is mounted; empty: the base
  std::vector<MountedCamera> cameras;
  std::vector<std::string> bumpers;  ///< links where the shell makes contact first
  std::vector<LaserScanner> lasers;
  std::vector<Sonar> sonars;
  std::optional<SE3> base_from_imu = {};
  OdometryErrors odometry;
  std::optional<CollisionReflex> reflex = {};

  /// The pose of a link with these joints moved (KinematicTree::root_from).
  SE3 base_from(std::string_view link, const std::map<std::string, double>& positions = {}) const {
    return base_from_root * tree.root_from(link, positions);
  }
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

  /// Its wheels; null if it has none.
  const WheelBase* wheels() const {
    return equipment && equipment->wheels ? &*equipment->wheels : nullptr;
  }
  /// Its wheels if they keep it from moving sideways, else null.
  const WheelBase* differential() const {
    const WheelBase* found = wheels();
    return found != nullptr && found->kind == WheelBase::Kind::kDifferential ? found : nullptr;
  }
};

/// Reads robots/<name>/<name>.yaml. @throws InputError naming file, line, field and value.
/// @param warnings  receives a line for each oddity in its files; may be null
Robot load_robot(const std::filesystem::path& file, std::vector<std::string>* warnings = nullptr);

}  // namespace mh
