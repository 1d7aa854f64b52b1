// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/labels.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// A point of a map with its class (kVoid: none).
struct LabeledPoint {
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();
  ClassId label = kVoid;
};

/// Where the floor is in a map whose frame is a camera's first pose.
struct FloorFrame {
  SE3 floor_from_world;    ///< z = 0 is the floor, z up; x is the first camera's viewing direction
  double spread_m = 0;     ///< median distance of the floor's points from the plane
  std::size_t points = 0;  ///< number of points on the floor
  bool by_labels = false;  ///< false: without usable labels, geometry decided
};

/// Finds the floor. It is the plane of the points labeled floor, if that is where a floor can be:
/// below the cameras and roughly perpendicular to their mean up axis, with almost nothing below it.
/// Otherwise, it is the plane with the most points for which this holds. Deterministic.
/// @param cameras  poses along the path, in order; their y axis points down
/// @returns nullopt if no plane can be a floor.
std::optional<FloorFrame> find_floor_frame(std::span<const LabeledPoint> points,
                                           std::span<const SE3> world_from_cameras);

}  // namespace mh
