// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slam/match/context.hpp"
#include "slam/track/tracker.hpp"

namespace mh {

/// A feature whose position is known only from the last frame's depth: not a landmark of the map
/// (a "temporal point" of ORB-SLAM2).
struct PassingPoint {
  std::uint32_t feature;
  Eigen::Vector3d position_in_world;
};

/// A camera pose with its supporting landmarks.
struct TrackedPose {
  SE3 camera_from_world;
  std::vector<LandmarkId> landmarks;  ///< per feature; inliers only
  int inliers = 0;
  Matrix6d information = Matrix6d::Zero();  ///< see PoseEstimate
  bool unsure = false;                      ///< the image alone does not determine the pose
  std::vector<PassingPoint> passing = {};   ///< inliers of track_motion() without a landmark
};

/// Estimates a frame's pose from the last frame and a motion guess: the last frame's landmarks, and
/// the points behind its other keypoints with depth, are searched for where the guess puts them.
/// @returns nullopt with fewer than TrackConfig::min_inliers_frame inliers.
std::optional<TrackedPose> track_motion(const Query& query, const LastFrame& last, const SE3& guess,
                                        const SlamContext& context);

/// Counts the last frame's points (as in track_motion) that the guess projects far enough inside
/// the image for a keypoint to be detected there. If there are few, the frame cannot be tracked
/// from the last one, however well its motion is known. "Far enough" is the margin that keypoints
/// keep from the border at the finest pyramid level.
int count_that_can_be_found(const LastFrame& last, const SE3& guess, const Map& map,
                            const Camera& camera);

/// Estimates a frame's pose from the landmarks around a rough guess.
/// @param radius_px  of the search at octave 0
/// @returns nullopt with fewer than TrackConfig::min_inliers_frame inliers.
std::optional<TrackedPose> track_near(const Query& query, const MapPose& guess, double radius_px,
                                      const SlamContext& context);

/// Estimates a frame's pose by appearance: words shared with the reference keyframe.
/// @returns nullopt with fewer than TrackConfig::min_inliers_frame inliers.
std::optional<TrackedPose> track_reference(const Query& query, KeyframeId reference,
                                           const SE3& guess, const SlamContext& context);

/// The part of the map that may be visible from a pose.
struct LocalMap {
  std::vector<KeyframeId> keyframes;
  std::vector<LandmarkId> landmarks;
};

/// The keyframe that shares the most landmarks with the frame, ties to the earliest; invalid if
/// none does.
KeyframeId reference_of(const TrackedPose& tracked, const Map& map);

/// Keyframes that share landmarks with the frame, their neighbors, and those nearby with a similar
/// view direction, even if they share no landmarks, so that revisited places are matched at once.
/// @param origin  of the piece of the map that the pose is in
LocalMap local_map(const TrackedPose& tracked, KeyframeId origin, const SlamContext& context);

struct LocalMapResult {
  TrackedPose tracked;
  std::vector<LandmarkId> expected;  ///< landmarks that should have been visible
};

/// Refines a pose with every landmark of the local map that is found in the frame, and with
/// `tracked.passing`.
/// @returns nullopt if the optimization fails.
std::optional<LocalMapResult> track_local_map(const Query& query, const TrackedPose& tracked,
                                              const LocalMap& local, const SlamContext& context);

/// Whether the map needs this frame as a keyframe.
bool needs_keyframe(const TrackedPose& tracked, const Features& features, KeyframeId reference,
                    int frames_since_keyframe, const SlamContext& context);

/// Optimizes a pose over matched landmarks and collects the inliers, per feature; the common last
/// step of all tracking stages.
/// @param passing  additional observations for features without a landmark: they constrain the pose
///                 but are not counted in `inliers`. In a young map, landmarks alone may cover only
///                 a narrow part of the image, in which rotation and translation look the same.
std::optional<TrackedPose> optimize_matches(const Query& query,
                                            const std::vector<LandmarkId>& landmarks,
                                            std::span<const PassingPoint> passing, const SE3& guess,
                                            const SlamContext& context);

}  // namespace mh
