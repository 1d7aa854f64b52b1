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
  std::optional<Motion> motion = {};  ///< with this frame taken in
};

/// Takes a frame that followed the last one into the motion. Where the picture alone leaves its
/// pose unsure (few points in a narrow strip: turning and shifting look alike), it is put between
/// where it was seen and where the motion leads, each by its covariance.
void weigh(Located& located, const Tracker& tracker, Stamp stamp_ns, const TrackConfig& config);

/// A frame placed by its motion alone, where the last one's points have left the picture: a corner
/// so bare that a turn lets go of all it showed. The motion must be as sure as a picture must be,
/// and what the frame shows itself enough to hold the next one.
std::optional<Located> carry(const Tracker& tracker, Stamp stamp_ns, const Features& features,
                             const SlamContext& context);

/// Keypoints of a frame that have depth.
int points_with_depth(const Features& features);

}  // namespace mh
