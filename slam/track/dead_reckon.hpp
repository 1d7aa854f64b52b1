// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "slam/config/track.hpp"
#include "slam/track/track.hpp"

namespace mh {

/// A frame's place in the map.
struct Located {
  TrackedPose tracked;
  KeyframeId reference;               ///< keyframe that shares most landmarks
  std::vector<LandmarkId> expected;   ///< landmarks that should have been visible
  std::optional<Motion> motion = {};  ///< updated with this frame
  Reckoning reckoning = {};           ///< 0 where the image tells the pose
};

/// A frame's place by odometry alone: what the wheels have done since the last frame, added to its
/// pose.
struct Reckoned {
  SE3 camera_from_world;
  Reckoning reckoning;
  Matrix6d covariance;  ///< grown since an image last told the pose

  /// Whether a pose by an image may be that of this frame. One by many landmarks overrules the
  /// wheels, which may slip, but not far within a frame.
  bool allows(const TrackedPose& tracked, const TrackConfig& config) const;
};
/// @returns nothing without odometry, or if its drift exceeds TrackConfig::odometry_position_m or
/// odometry_angle_rad
std::optional<Reckoned> reckon_by_odometry(const Tracker& tracker,
                                           const std::optional<SE3>& odom_from_camera,
                                           const TrackConfig& config);

/// Updates the motion filter with a frame that follows the last one. If the image alone leaves the
/// pose uncertain (few points in a narrow strip: rotation and translation look alike), the pose is
/// fused with the predicted one, each weighted by its covariance.
/// @param reckoned  predicts in the filter's place
void fuse_with_prediction(Located& located, const Tracker& tracker, Stamp stamp_ns,
                          const std::optional<Reckoned>& reckoned, const TrackConfig& config);

/// Places a frame by motion alone when the last frame's points have left the image: for example a
/// turn in so bare a corner that nothing seen before remains in view. The predicted pose must
/// satisfy the limits of TrackConfig::sure_position_m and sure_angle_rad, and the frame itself must
/// show enough to track the next one.
std::optional<Located> dead_reckon(const Tracker& tracker, Stamp stamp_ns, const Features& features,
                                   const SlamContext& context);

/// Keypoints of a frame that have depth.
int points_with_depth(const Features& features);

}  // namespace mh
