// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/match/context.hpp"

namespace mh {

/// Creates a landmark for every close feature with depth; if there are fewer than a hundred, for
/// the nearest hundred features with depth.
void add_landmarks_from_depth(Map& map, KeyframeId keyframe, const SlamContext& context);

// `map` is the context's own map, which is modified.

/// Processes a new keyframe, in order: culls young landmarks that did not prove themselves,
/// triangulates new ones with neighbors, fuses duplicates, adjusts the neighborhood, culls
/// redundant keyframes.
void map_keyframe(Map& map, KeyframeId keyframe, const SlamContext& context);

// The stages of map_keyframe, exposed for tests.
void cull_young_landmarks(Map& map, KeyframeId newest);
void triangulate_with_neighbors(Map& map, KeyframeId keyframe, const SlamContext& context);
void fuse_with_neighbors(Map& map, KeyframeId keyframe, const SlamContext& context);
void adjust_neighborhood(Map& map, KeyframeId keyframe, const SlamContext& context);
/// Bundle adjustment of a whole piece of the map; its first keyframe is fixed.
void adjust_piece(Map& map, KeyframeId origin, const SlamContext& context);
void cull_redundant_keyframes(Map& map, KeyframeId newest, const SlamContext& context);

}  // namespace mh
