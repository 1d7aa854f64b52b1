// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"
#include "slam/features/features.hpp"
#include "slam/relocalize/stale_scores.hpp"
#include "slam/track/inertial.hpp"
#include "slam/track/motion.hpp"

namespace mh {

/// The last tracked frame, to match the next one against.
struct LastFrame {
  Stamp stamp_ns = 0;
  SE3 camera_from_world;
  Features features;
  std::vector<LandmarkId> landmarks;  ///< per feature; invalid = none
  std::optional<SE3> odom_from_camera = {};
};

/// How the camera has moved since an image last determined the pose.
struct Reckoning {
  double distance_m = 0, turn_rad = 0;
  bool is_zero() const { return distance_m == 0 && turn_rad == 0; }
};

/// State of tracking between frames; Tracker{} is lost. It has two motion models. The step between
/// the last two poses predicts where to search for points, since it follows a start or a stop at
/// once. The filter over all frames also gives the uncertainty of its prediction, which is fused
/// with a pose that the image alone leaves uncertain.
struct Tracker {
  std::optional<LastFrame> last;  ///< none: nothing mapped yet, or lost for longer than coast_s
                                  ///< (relocalization may still recover)
  std::optional<Vector6d> velocity_per_s;  ///< twist of the camera, in its own frame
  std::optional<Motion> motion;            ///< over all frames since tracking began
  KeyframeId reference;                    ///< keyframe that shares the most landmarks
  int frames_since_keyframe = 0;
  bool coasting = false;                   ///< lost since `last`, but still within coast_s
  Reckoning reckoning;                     ///< up to `last`
  std::optional<InertialMotion> inertial;  ///< at `last`; absent without a sensor
  /// What the inertial filter has learned; kept when tracking is lost.
  std::optional<InertialMotion::Known> inertial_known;
  StaleScores stale_scores;  ///< kept when tracking is lost

  bool tracking() const { return last.has_value() && !coasting; }
};

/// @pre tracker.last
double seconds_since_last(const Tracker& tracker, Stamp stamp_ns);

/// Predicts camera_from_world at a stamp by continuing the last step; the last pose if no velocity
/// is known.
/// @pre tracker.last
SE3 predict(const Tracker& tracker, Stamp stamp_ns);

/// The camera's motion since the last frame from odometry, camera_now_from_camera_last; nullopt
/// unless both frames have odometry. @pre tracker.last
std::optional<SE3> odometry_step(const Tracker& tracker,
                                 const std::optional<SE3>& odom_from_camera);

/// Updates the velocity from the camera's motion since the last frame. Call before mapping, which
/// may move the world.
void update_velocity(Tracker& tracker, Stamp stamp_ns, const SE3& camera_from_world);

/// Records a tracked frame, to match the next one against.
void remember(Tracker& tracker, LastFrame frame, KeyframeId reference,
              const std::optional<Motion>& motion);

/// Forgets the last frame and the motion.
void forget(Tracker& tracker);

/// Records a lost frame. For `coast_s`, the last tracked frame still predicts where to look for the
/// next.
void lose(Tracker& tracker, Stamp stamp_ns, double coast_s);

}  // namespace mh
