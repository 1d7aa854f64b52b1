// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/map/local_mapping.hpp"
#include "slam/relocalize/relocalize.hpp"

namespace mh {

struct LoopConfig {
  bool enabled = true;
  bool augmented = false;  ///< candidates by equation 1 with labels; else by words alone
  int min_gap = 10;        ///< keyframes between the two ends, at least
  /// The ends share fewer landmarks than this: chance matches across a drift of some centimeters
  /// tie them too loosely to undo it.
  int loosely_shared = 60;
  /// A candidate's similarity, at least, as a share of that of the least alike strong neighbor.
  double min_similarity_share = 0.5;
  int agreeing = 2;            ///< keyframes that must tell of the same drift,
  int patience = 5;            ///< each at most so many keyframes after the one before
  double same_drift_m = 0.10;  ///< what counts as the same
  double same_drift_rad = 0.05;
  /// Nobody drifts by more than this, and this share of the way between the ends: what looks so is
  /// another place that looks the same.
  double max_drift_m = 0.3, max_drift_share = 0.03;
  double max_drift_rad = 0.35;
  double negligible_m = 0.01;  ///< below, landmarks are joined but poses stay
  double negligible_rad = 0.003;
};

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
std::optional<Loop> detect_loop(const Map& map, KeyframeId newest, LoopMemory& memory,
                                const MappingContext& context, const RelocalizeConfig& relocalize,
                                const LoopConfig& config, RandomStream stream, MatchCounts& counts);

/// Closes a loop: the drift is spread over the graph of keyframes, landmarks move along, the two
/// ends' landmarks become one, and the whole map is adjusted.
void close_loop(Map& map, const Loop& loop, const MappingContext& context, const LoopConfig& config,
                MatchCounts& counts);

}  // namespace mh
