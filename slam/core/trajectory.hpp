// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// The camera pose at a time.
struct TimedPose {
  Stamp stamp_ns = 0;
  SE3 world_from_camera;
  std::uint32_t map = 0;  ///< whose world it is, of a system that keeps several
};

/// Poses ordered by strictly increasing stamp.
using Trajectory = std::vector<TimedPose>;

}  // namespace mh
