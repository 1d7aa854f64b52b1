// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"
#include "slam/occupancy/occupancy_mapper.hpp"

namespace mh {

// A box room, seen from inside: every ray ends at the nearest of six planes. The planes are not at
// borders of voxels. The room is labeled: floor, ceiling, wall, and a door on one wall.
inline const Eigen::Vector3d kRoomMin(-1.52, -1.02, 0.02), kRoomMax(2.02, 1.27, 2.52);
inline const Eigen::Vector3d kEye(0.01, 0.01, 0.51);
inline constexpr ClassId kWallLabel = 1, kFloorLabel = 2, kCeilingLabel = 22;

inline Camera room_camera() {
  Camera camera;
  camera.width_px = 160;
  camera.height_px = 120;
  camera.fx_px = camera.fy_px = 145.0;
  camera.cx_px = 79.5;
  camera.cy_px = 59.5;
  return camera;
}

/// The pose of a level camera; `aside_m` moves it along y.
inline SE3 room_pose(double heading_rad, double aside_m = 0) {
  Eigen::Matrix3d body_from_optical;
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()) * body_from_optical,
          kEye + Eigen::Vector3d(0, aside_m, 0)};
}

inline RgbdFrame room_frame(Stamp stamp_ns, const SE3& pose) {
  const Camera camera = room_camera();
  RgbdFrame frame;
  frame.stamp_ns = stamp_ns;
  frame.depth_m = Grid2d<float>(camera.width_px, camera.height_px);
  frame.semantics.index = Grid2d<std::uint8_t>(camera.width_px, camera.height_px);
  for (const ClassId id : {kVoid, kWallLabel, kFloorLabel, kCeilingLabel})
    frame.semantics.palette.push_back(ClassDistribution::one_hot(id));
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector3d ray = pose.rotation() * camera.unproject(x, y, 1.0);
      double z = std::numeric_limits<double>::infinity();
      std::uint8_t label = 0;
      for (int axis = 0; axis < 3; ++axis) {
        if (ray[axis] == 0) continue;
        const double to =
            ((ray[axis] > 0 ? kRoomMax : kRoomMin)[axis] - pose.translation()[axis]) / ray[axis];
        if (to >= z) continue;
        z = to;
        label = axis < 2 ? 1 : ray[axis] < 0 ? 2 : 3;
      }
      frame.depth_m(x, y) = static_cast<float>(z);
      frame.semantics.index(x, y) = label;
    }
  return frame;
}

inline OccupancyConfig every_pixel(double max_range_m = 4.0) {
  OccupancyConfig config;
  config.depth.max_range_m = max_range_m;
  config.depth.min_range_m = 0.1;
  config.stride_px = 1;
  return config;
}

/// The poses of one full turn.
inline Trajectory look_around(double aside_m = 0) {
  Trajectory poses;
  for (int i = 0; i < 16; ++i) poses.push_back({i, room_pose(i * std::numbers::pi / 8, aside_m)});
  return poses;
}

/// The room mapped in one full turn.
inline OccupancyMapper mapped_room(double max_range_m = 4.0) {
  OccupancyMapper mapper(room_camera(), every_pixel(max_range_m));
  for (const TimedPose& pose : look_around())
    mapper.keep(room_frame(pose.stamp_ns, pose.world_from_camera));
  mapper.update(look_around());
  return mapper;
}

}  // namespace mh
