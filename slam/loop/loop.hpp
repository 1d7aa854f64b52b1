// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "slam/core/random.hpp"
#include "slam/match/context.hpp"
#include "slam/relocalize/relocalize.hpp"

namespace mh {

/// A possible pose of one piece of the map in another, and the keyframes that support it.
struct PiecePlace {
  KeyframeId origin, other;  ///< Keyframe::origin of the two pieces
  SE3 other_from_own;   ///< between the two pieces' worlds, according to the last keyframe that
                        ///< agreed
  KeyframeId keyframe;  ///< the last keyframe that agreed
  int agreeing = 0;     ///< keyframes that agreed so far
  double way_m = 0;     ///< length of the path through the keyframes that agreed
};

/// What loop detection remembers between keyframes.
struct LoopMemory {
  /// Correction (world_from_world) that moves the camera from its estimated place to where the last
  /// keyframe that recognized a place would put it.
  std::optional<SE3> drift;
  KeyframeId keyframe;                  ///< the keyframe that found `drift`
  int agreeing = 0;                     ///< keyframes that agreed on the drift so far
  std::vector<PiecePlace> places = {};  ///< of pieces that are not joined yet
};

/// A recognized place: the newest keyframe sees a part of the map with which it shares little, or
/// another piece of the map.
struct Loop {
  KeyframeId keyframe;      ///< the newest
  KeyframeId old_keyframe;  ///< the keyframe of the recognized place
  SE3 camera_from_world;  ///< the newest keyframe's pose, estimated from the old landmarks, in the
                          ///< old keyframe's world
  std::vector<LandmarkId>
      landmarks;  ///< the old landmark of each feature of the newest keyframe; invalid = none
};

/// Looks for the newest keyframe's place among keyframes that share little with it. Candidates are
/// selected by words (equations 3 to 6) and checked geometrically as in relocalization; then
/// several keyframes must agree.
std::optional<Loop> detect_loop(KeyframeId newest, LoopMemory& memory, const SlamContext& context,
                                RandomStream stream);

/// Looks for the newest keyframe's place in other pieces of the map. A place is accepted once
/// LoopConfig::joining keyframes agree on it, over a path of LoopConfig::joining_m, and no other
/// place is supported by half as many keyframes or more.
/// @param is_reachable  whether the newest keyframe's piece can be where a place puts it. Its
///   argument holds the other piece's origin and, as camera_from_world, PiecePlace::other_from_own
std::optional<Loop> recognize_piece(KeyframeId newest, LoopMemory& memory,
                                    const SlamContext& context, RandomStream stream,
                                    const IsPossible& is_reachable);

/// Closes a loop: distributes the drift over the keyframe graph, moves landmarks along, merges the
/// landmarks of the two ends, and adjusts the whole piece of the map. If its ends are in different
/// pieces, the later piece first becomes part of the other.
/// @param map  the context's own map, which is modified
void close_loop(Map& map, const Loop& loop, const SlamContext& context);

}  // namespace mh
