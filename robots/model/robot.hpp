// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "slam/core/camera.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Limits of a holonomic base.
struct BaseLimits {
  double max_velocity_m_per_s = 0.35;
  double max_acceleration_m_per_s2 = 0.3;
  double max_turn_rad_per_s = 1.0;
  double max_turn_acceleration_rad_per_s2 = 0.75;
};

/// A robot as the simulator needs it. Base frame: on the floor, x forward, z up.
struct Robot {
  std::string name;
  double mass_kg = 0.0;
  double footprint_radius_m = 0.26;
  double height_m = 1.21;
  BaseLimits limits;
  Camera camera;                 ///< the RGB-D camera
  SE3 base_from_camera;          ///< optical frame: x right, y down, z forward
};

/// Reads robots/<name>/<name>.yaml. @throws InputError naming file, line, field and value.
Robot load_robot(const std::filesystem::path& file);

}  // namespace mh
