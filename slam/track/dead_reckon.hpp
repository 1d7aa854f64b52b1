// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slam/config/track.hpp"
#include "slam/track/track.hpp"

namespace mh {

/// A frame's place in the map.
struct Located {
  TrackedPose tracked;
  KeyframeId reference;                         ///< keyframe that shares the most landmarks
  std::vector<LandmarkId> expected;             ///< landmarks that should have been visible
  std::optional<Motion> motion = {};            ///< updated with this frame
  Reckoning reckoning = {};                     ///< 0 if the image determines the pose
  std::optional<InertialMotion> inertial = {};  ///< at this frame
};

/// A frame's pose according to another sensor alone: the last frame's pose plus the motion that the
/// wheels or the inertial sensor have measured since.
struct Reckoned {
  SE3 camera_from_world;
  Reckoning reckoning;
  Matrix6d covariance;  ///< it grows until an image determines the pose again
  std::optional<InertialMotion> inertial = {};  ///< at this frame, if that sensor was used

  /// Whether a pose from an image may be that of this frame. One based on many landmarks overrules
  /// the sensor, since wheels may slip, but only by as much as they can slip within a frame.
  bool allows(const TrackedPose& tracked, const TrackConfig& config) const;
};
/// @returns nullopt without such a sensor, or if the drift exceeds TrackConfig::reckon_position_m
/// or reckon_angle_rad. If there are both wheels and an inertial sensor, the wheels are used.
std::optional<Reckoned> reckon(const Tracker& tracker, Stamp stamp_ns,
                               const std::optional<SE3>& odom_from_camera,
                               std::span<const ImuReading> imu, const TrackConfig& config);

/// Updates the inertial sensor's filter with a frame that was located; starts it if it has not
/// started. @pre the pose is final
void follow_inertially(Located& located, const std::optional<Reckoned>& reckoned,
                       std::span<const ImuReading> imu, const Tracker& tracker);

/// Updates the motion filter with a frame that follows the last one. If the image alone leaves the
/// pose uncertain (few points in a narrow strip, where rotation and translation look the same), the
/// pose is fused with the predicted one, each weighted by its covariance.
/// @param reckoned  if present, its prediction replaces the filter's
void fuse_with_prediction(Located& located, const Tracker& tracker, Stamp stamp_ns,
                          const std::optional<Reckoned>& reckoned, const TrackConfig& config);

/// Places a frame by motion alone when the last frame's points have left the image, for example
/// after a turn in so bare a corner that nothing seen before remains in view. The predicted pose
/// must satisfy the limits of TrackConfig::sure_position_m and sure_angle_rad, and the frame itself
/// must show enough to track the next one.
std::optional<Located> dead_reckon(const Tracker& tracker, Stamp stamp_ns, const Features& features,
                                   const SlamContext& context);

/// Number of a frame's keypoints that have depth.
int points_with_depth(const Features& features);

}  // namespace mh
