// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/camera.hpp"
#include "slam/map/keyframe_config.hpp"
#include "slam/map/map.hpp"
#include "slam/match/config.hpp"
#include "slam/match/counts.hpp"
#include "slam/match/trace.hpp"
#include "slam/optimize/bundle.hpp"

namespace mh {

/// What mapping works with; references live as long as the step.
struct MappingContext {
  const Camera& camera;
  const FeatureConfig& features;
  const SemanticConfig& semantics;
  const MatchConfig& match;
  const BundleConfig& bundle;
  const KeyframeConfig& config;
  MatchTrace* trace = nullptr;  ///< where accepted pairs are noted, if anywhere
};

/// Gives every close feature with depth (and at least the nearest hundred) a landmark of its own.
void add_landmarks_from_depth(Map& map, KeyframeId keyframe, const MappingContext& context);

/// All that a new keyframe sets off, in order: young landmarks that did not prove themselves go,
/// new ones are triangulated with neighbors, doubles are fused, the neighborhood is adjusted,
/// redundant keyframes go.
void map_keyframe(Map& map, KeyframeId keyframe, const MappingContext& context,
                  MatchCounts& counts);

// The stages of map_keyframe, each on its own for tests.
void cull_young_landmarks(Map& map, KeyframeId newest);
void triangulate_with_neighbors(Map& map, KeyframeId keyframe, const MappingContext& context,
                                MatcherCounts& counts);
void fuse_with_neighbors(Map& map, KeyframeId keyframe, const MappingContext& context,
                         MatcherCounts& counts);
void adjust_neighborhood(Map& map, KeyframeId keyframe, const MappingContext& context);
/// Bundle adjustment of the whole map; the first keyframe is held.
void adjust_all(Map& map, const MappingContext& context);
void cull_redundant_keyframes(Map& map, KeyframeId newest, const MappingContext& context);

}  // namespace mh
