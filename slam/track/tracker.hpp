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

/// What tracking remembers between frames; Tracker{} is lost. It holds two motions: the step
/// between the last two poses says where to search, since it follows a start or a stop at once; the
/// filter over all frames says how sure a prediction is, and is weighed against an unsure pose.
struct Tracker {
  std::optional<LastFrame> last;           ///< none = lost for good (or nothing mapped yet)
  std::optional<Vector6d> velocity_per_s;  ///< twist of the camera, in its own frame
  std::optional<Motion> motion;            ///< over all frames since tracking began
  KeyframeId reference;                    ///< keyframe that shares most landmarks
  int frames_since_keyframe = 0;
  bool coasting = false;  ///< lost since `last`, which is still worth a try

  bool tracking() const { return last.has_value() && !coasting; }
};

/// @pre tracker.last
double seconds_since_last(const Tracker& tracker, Stamp stamp_ns);

/// camera_from_world at a stamp if the last step goes on; the last pose where none is known.
/// @pre tracker.last
SE3 predict(const Tracker& tracker, Stamp stamp_ns);

/// How the camera moved since the last frame. To be taken before mapping, which may move the world.
void update_velocity(Tracker& tracker, Stamp stamp_ns, const SE3& camera_from_world);

/// The frame is tracked: the next one is matched against it.
void remember(Tracker& tracker, LastFrame frame, KeyframeId reference,
              const std::optional<Motion>& motion);

/// The frame is lost. For `coast_s` the last tracked one still says where to look for the next.
void lose(Tracker& tracker, Stamp stamp_ns, double coast_s);

}  // namespace mh
