// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/camera.hpp"
#include "slam/map/map.hpp"
#include "slam/match/counts.hpp"
#include "slam/match/match.hpp"
#include "slam/match/trace.hpp"

namespace mh {

struct SlamConfig;

/// A frame or keyframe prepared for search: its features with index and bag of words.
struct Query {
  const Features& features;
  const FeatureGrid& grid;
  const WordIndex& words;
};

/// What every stage of a step works with; the references live as long as the step.
struct SlamContext {
  const Camera& camera;
  const SlamConfig& config;
  const Map& map;               ///< to be read; stages that change it take it as `Map&` beside this
  MatchCounts& counts;          ///< grows by what equation 2 does
  MatchTrace* trace = nullptr;  ///< gets every accepted pair, where somebody wants them
};

/// Equation 2 under the context's settings, counted under a matcher's name.
SemanticMatcher semantic_matcher(const SlamContext& context, Matcher matcher);

/// The landmarks that a keyframe sees, matched to a frame by appearance alone (words, tight gate,
/// ratio test) and traced: one per feature of the frame, invalid = none.
std::vector<LandmarkId> match_landmarks(const Keyframe& keyframe, const Query& query,
                                        const SlamContext& context, Matcher matcher);

/// Pairs that match_by_projection() accepted.
struct ProjectionPairs {
  KeyframeId seen_in;  ///< whose features they are; invalid = the frame of this step
  const Features& features;
  std::span<const ProjectionTarget> targets;
  std::span<const std::int32_t> found;         ///< per target
  std::span<const LandmarkId> landmarks;       ///< of each target
  std::span<const std::uint32_t> others = {};  ///< feature that lent each target its descriptor;
                                               ///< empty = the landmark's own
};
/// Notes them where the context has a trace.
void trace_projection(const SlamContext& context, Matcher matcher, const ProjectionPairs& pairs);

/// Pairs that match_by_words() accepted between a keyframe and another, or the frame of this step.
struct WordPairs {
  KeyframeId a;
  const Features& features_a;
  std::span<const LandmarkId> landmarks_a;  ///< empty = none counts
  KeyframeId b;                             ///< invalid = the frame of this step
  const Features& features_b;
  std::span<const FeatureMatch> matches;
};
/// Notes them where the context has a trace.
void trace_words(const SlamContext& context, Matcher matcher, const WordPairs& pairs);

}  // namespace mh
