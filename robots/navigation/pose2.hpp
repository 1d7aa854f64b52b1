// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "slam/core/se3.hpp"

namespace mh {

/// A pose in the plane, named target_from_source as an SE3 is.
struct Pose2 {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;

  Eigen::Vector2d turned(const Eigen::Vector2d& v) const {
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
  }
  Pose2 inverse() const {
    const Pose2 back{Eigen::Vector2d::Zero(), -heading_rad};
    return {-back.turned(place_m), -heading_rad};
  }
  friend Eigen::Vector2d operator*(const Pose2& a, const Eigen::Vector2d& point) {
    return a.turned(point) + a.place_m;
  }
  friend Pose2 operator*(const Pose2& a, const Pose2& b) {
    return {a * b.place_m, std::remainder(a.heading_rad + b.heading_rad, 2 * M_PI)};
  }
};

/// A pose in space, seen from above.
inline Pose2 from_above(const SE3& pose) {
  const Eigen::Vector3d ahead = pose.rotation().col(0);
  return {pose.translation().head<2>(), std::atan2(ahead.y(), ahead.x())};
}

/// The angle from one heading to another, in [-pi, pi].
inline double turn_to(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad, 2 * M_PI);
}

}  // namespace mh
