// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"
#include "slam/features/features.hpp"
#include "slam/track/motion.hpp"

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
  std::optional<LastFrame> last;           ///< none = lost for good (or nothing mapped yet)
  std::optional<Vector6d> velocity_per_s;  ///< twist of the camera, in its own frame
  std::optional<Motion> motion;            ///< over all frames since tracking began
  KeyframeId reference;                    ///< keyframe that shares most landmarks
  int frames_since_keyframe = 0;
  bool coasting = false;  ///< lost since `last`, which is still worth a try

  bool tracking() const { return last.has_value() && !coasting; }
};

}  // namespace mh
