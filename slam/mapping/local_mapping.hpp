// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/match/context.hpp"

namespace mh {

/// Gives every close feature with depth (and at least the nearest hundred) a landmark of its own.
void add_landmarks_from_depth(Map& map, KeyframeId keyframe, const SlamContext& context);

// `map` is the context's own, to be changed.

/// All that a new keyframe sets off, in order: young landmarks that did not prove themselves go,
/// new ones are triangulated with neighbors, doubles are fused, the neighborhood is adjusted,
/// redundant keyframes go.
void map_keyframe(Map& map, KeyframeId keyframe, const SlamContext& context);

// The stages of map_keyframe, each on its own for tests.
void cull_young_landmarks(Map& map, KeyframeId newest);
void triangulate_with_neighbors(Map& map, KeyframeId keyframe, const SlamContext& context);
void fuse_with_neighbors(Map& map, KeyframeId keyframe, const SlamContext& context);
void adjust_neighborhood(Map& map, KeyframeId keyframe, const SlamContext& context);
/// Bundle adjustment of the whole map; the first keyframe is held.
void adjust_all(Map& map, const SlamContext& context);
void cull_redundant_keyframes(Map& map, KeyframeId newest, const SlamContext& context);

}  // namespace mh
