// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slam/match/context.hpp"
#include "slam/track/tracker.hpp"

namespace mh {

/// A feature whose place is known from the last frame's depth alone: no landmark of the map.
struct PassingPoint {
  std::uint32_t feature;
  Eigen::Vector3d position_in_world;
};

/// A camera pose with the landmarks that support it.
struct TrackedPose {
  SE3 camera_from_world;
  std::vector<LandmarkId> landmarks;  ///< per feature; inliers only
  int inliers = 0;
  Matrix6d information = Matrix6d::Zero();  ///< see PoseEstimate
  bool unsure = false;                      ///< the picture alone does not fix the pose
  std::vector<PassingPoint> passing = {};   ///< inliers of the motion model without a landmark
};

/// The pose of a frame from the last one and a guess of the motion: the last frame's landmarks, and
/// the points behind its other keypoints with depth, are looked for where the guess puts them.
/// @returns nullopt below TrackConfig::min_inliers_frame.
std::optional<TrackedPose> track_motion(const Query& query, const LastFrame& last, const SE3& guess,
                                        const SlamContext& context);

/// How many of the last frame's points (as in track_motion) the guess puts where a keypoint can be:
/// if they are few, no frame there holds by the last one, however well its motion is known. The
/// border is that of the finest level.
int count_that_can_be_found(const LastFrame& last, const SE3& guess, const Map& map,
                            const Camera& camera);

/// The pose of a frame by appearance: words shared with the reference keyframe.
/// @returns nullopt below TrackConfig::min_inliers_frame.
std::optional<TrackedPose> track_reference(const Query& query, KeyframeId reference,
                                           const SE3& guess, const SlamContext& context);

/// The part of the map that a pose may see.
struct LocalMap {
  std::vector<KeyframeId> keyframes;
  std::vector<LandmarkId> landmarks;
};

/// The keyframe that shares most landmarks with the frame, the earliest of equals; invalid if none
/// does.
KeyframeId reference_of(const TrackedPose& tracked, const Map& map);

/// Keyframes that share landmarks with the frame, their neighbors, and those that stand near and
/// look alike, whatever they share: so a place seen long ago is found again without a detour.
LocalMap local_map(const TrackedPose& tracked, const SlamContext& context);

struct LocalMapResult {
  TrackedPose tracked;
  std::vector<LandmarkId> expected;  ///< landmarks that should have been visible
};

/// Refines a pose with every landmark of the local map that can be found in the frame, and with the
/// points that pass by.
/// @returns nullopt if the optimization fails.
std::optional<LocalMapResult> track_local_map(const Query& query, const TrackedPose& tracked,
                                              const LocalMap& local, const SlamContext& context);

/// Whether the map needs this frame as a keyframe.
bool needs_keyframe(const TrackedPose& tracked, const Features& features, KeyframeId reference,
                    int frames_since_keyframe, const SlamContext& context);

/// Landmarks of the inlier observations, per feature; the front of every tracking stage's end.
/// @param passing  observed too where the feature has no landmark, but no inliers: where the map is
///                 young, landmarks alone may cover a narrow part of the picture, in which turning
///                 and shifting look alike.
std::optional<TrackedPose> optimize_matches(const Query& query,
                                            const std::vector<LandmarkId>& landmarks,
                                            std::span<const PassingPoint> passing, const SE3& guess,
                                            const SlamContext& context);

}  // namespace mh
