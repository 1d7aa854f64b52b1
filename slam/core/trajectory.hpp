// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// The camera pose at a time.
struct TimedPose {
  Stamp stamp_ns = 0;
  SE3 world_from_camera;
  std::uint32_t map = 0;  ///< the map in whose world the pose is, for a system with several maps
};

/// Poses ordered by strictly increasing stamp.
using Trajectory = std::vector<TimedPose>;

/// The poses in one map.
inline Trajectory of_map(const Trajectory& all, std::uint32_t map) {
  Trajectory poses;
  for (const TimedPose& pose : all)
    if (pose.map == map) poses.push_back(pose);
  return poses;
}

/// The map with the most poses; ties go to the lower number. 0 if there are no poses.
inline std::uint32_t largest_map(const Trajectory& all) {
  std::map<std::uint32_t, std::size_t> poses_of;
  for (const TimedPose& pose : all) ++poses_of[pose.map];
  std::uint32_t largest = 0;
  std::size_t most = 0;
  for (const auto& [map, poses] : poses_of)
    if (poses > most) largest = map, most = poses;
  return largest;
}

}  // namespace mh
