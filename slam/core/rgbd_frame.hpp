// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/grid2d.hpp"
#include "slam/core/labels.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Time in integer nanoseconds.
using Stamp = std::int64_t;

/// 8-bit sRGB color.
struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// Per-pixel class distributions, stored as a palette: pixel (x, y) has distribution
/// palette[index(x, y)]. Pixels with the same entry belong together: there is one entry for each
/// detection of a detector, for each visible object in exact labels, and for each class in a
/// recording's labels. An empty index grid means that the frame has no labels.
struct SemanticImage {
  Grid2d<std::uint8_t> index;
  std::vector<ClassDistribution> palette;

  /// The class distribution at a pixel; empty (void) where there are no labels.
  const ClassDistribution& at(int x, int y) const {
    static const ClassDistribution kNothing;
    return index.empty() ? kNothing : palette[index(x, y)];
  }
  friend bool operator==(const SemanticImage&, const SemanticImage&) = default;
};

/// A reading of an inertial sensor in the camera's housing; axes of the camera (x right, y down, z
/// forward), origin in its center.
struct ImuReading {
  Stamp stamp_ns = 0;
  Eigen::Vector3d turn_rad_per_s = Eigen::Vector3d::Zero();           ///< gyroscope
  Eigen::Vector3d specific_force_m_per_s2 = Eigen::Vector3d::Zero();  ///< accelerometer: at rest
                                                                      ///< 9.81 upward
  friend bool operator==(const ImuReading&, const ImuReading&) = default;
};

/// A fan of rays that a laser measured, in a plane through its origin; ray k points along the
/// laser's x axis, turned about z by first_rad + k * step_rad.
struct LaserScan {
  std::string name;
  SE3 camera_from_laser;  ///< at the frame's stamp, from the joints between camera and laser
  double first_rad = 0, step_rad = 0;
  double min_range_m = 0, max_range_m = 0;
  std::vector<float> ranges_m;  ///< 0 = nothing in range
};

/// Everything SLAM sees of one instant: no pose, no instance ids, no ground truth.
struct RgbdFrame {
  Stamp stamp_ns = 0;
  Grid2d<Rgb8> color;
  Grid2d<float> depth_m;  ///< along the optical axis, registered to color; 0 = no return
  SemanticImage semantics;
  /// Camera pose by wheel odometry alone at the stamp, in a frame of reference that drifts. Absent:
  /// no odometry.
  std::optional<SE3> odom_from_camera = {};
  /// What the inertial sensor delivered since the previously shown frame, in order of stamps.
  std::vector<ImuReading> imu = {};
  std::vector<LaserScan> lasers = {};  ///< at the stamp
};

}  // namespace mh
