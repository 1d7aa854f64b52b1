// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// The camera pose at a time.
struct TimedPose {
  Stamp stamp_ns = 0;
  SE3 world_from_camera;
};

/// Poses ordered by strictly increasing stamp.
using Trajectory = std::vector<TimedPose>;

}  // namespace mh
