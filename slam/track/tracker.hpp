// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"
#include "slam/features/features.hpp"

namespace mh {

/// The last tracked frame, as the next one is matched against it.
struct LastFrame {
  Stamp stamp_ns = 0;
  SE3 camera_from_world;
  Features features;
  std::vector<LandmarkId> landmarks;  ///< per feature; invalid = none
};

/// What tracking remembers between frames; Tracker{} is lost.
struct Tracker {
  bool tracking = false;                 ///< false = lost (or nothing mapped yet)
  std::optional<LastFrame> last;
  std::optional<SE3> last_motion;        ///< current_from_previous camera motion, per frame
  KeyframeId reference;                  ///< keyframe that shares most landmarks
  int frames_since_keyframe = 0;
};

}  // namespace mh
