// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/core/random.hpp"
#include "slam/match/context.hpp"

namespace mh {

/// What loop detection remembers between keyframes.
struct LoopMemory {
  /// world_from_world: where the last keyframe that recognized a place would put the camera, from
  /// where it is.
  std::optional<SE3> drift;
  KeyframeId keyframe;  ///< that keyframe
  int agreeing = 0;     ///< keyframes that agreed on the drift so far
};

/// A place recognized: the keyframe as seen by a part of the map that it shares little with.
struct Loop {
  KeyframeId keyframe;                ///< the newest
  KeyframeId old_keyframe;            ///< where it was recognized
  SE3 camera_from_world;              ///< the newest keyframe's pose by the old landmarks
  std::vector<LandmarkId> landmarks;  ///< old landmarks per feature of the newest keyframe
};

/// Looks for the newest keyframe among those that share little with it: candidates by words
/// (equations 3 to 6), geometric check as in relocalization, agreement of several keyframes.
std::optional<Loop> detect_loop(KeyframeId newest, LoopMemory& memory, const SlamContext& context,
                                RandomStream stream);

/// Closes a loop: the drift is spread over the graph of keyframes, landmarks move along, the two
/// ends' landmarks become one, and the whole map is adjusted.
/// @param map  the context's own, to be changed
void close_loop(Map& map, const Loop& loop, const SlamContext& context);

}  // namespace mh
