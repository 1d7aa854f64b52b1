// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/core/random.hpp"
#include "slam/match/context.hpp"

namespace mh {

/// What loop detection remembers between keyframes.
struct LoopMemory {
  /// world_from_world correction: from where the camera is to where the last keyframe that
  /// recognized a place would put it.
  std::optional<SE3> drift;
  KeyframeId keyframe;  ///< the keyframe that found `drift`
  int agreeing = 0;     ///< keyframes that agreed on the drift so far
};

/// A recognized place: the newest keyframe, seen by a part of the map with which it shares little.
struct Loop {
  KeyframeId keyframe;                ///< the newest
  KeyframeId old_keyframe;            ///< the keyframe of the recognized place
  SE3 camera_from_world;              ///< the newest keyframe's pose from the old landmarks
  std::vector<LandmarkId> landmarks;  ///< old landmarks per feature of the newest keyframe
};

/// Looks for the newest keyframe's place among keyframes that share little with it: candidates by
/// words (equations 3 to 6), geometric check as in relocalization, agreement of several keyframes.
std::optional<Loop> detect_loop(KeyframeId newest, LoopMemory& memory, const SlamContext& context,
                                RandomStream stream);

/// Closes a loop: distributes the drift over the keyframe graph, moves landmarks along, merges the
/// landmarks of the two ends, and adjusts the whole map.
/// @param map  the context's own map, which is modified
void close_loop(Map& map, const Loop& loop, const SlamContext& context);

}  // namespace mh
