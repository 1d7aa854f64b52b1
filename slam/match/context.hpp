// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/camera.hpp"
#include "slam/core/match_counts.hpp"
#include "slam/map/map.hpp"
#include "slam/match/match.hpp"
#include "slam/match/trace.hpp"

namespace mh {

struct SlamConfig;

/// A frame or keyframe prepared for search: its features, spatial index and bag of words.
struct Query {
  const Features& features;
  const FeatureGrid& grid;
  const WordIndex& words;
};

/// What every stage of a step works with; the references are valid for the duration of the step.
struct SlamContext {
  const Camera& camera;
  const SlamConfig& config;
  const Map& map;               ///< read-only; stages that modify it take it as `Map&` in addition
  MatchCounts& counts;          ///< incremented by each use of equation 2
  MatchTrace* trace = nullptr;  ///< receives every accepted pair, if not null
  DecisionTrace* decisions = nullptr;  ///< receives the outcome of every pair, if not null
};

/// Equation 2 under the context's settings, counted under a matcher's name.
SemanticMatcher semantic_matcher(const SlamContext& context, Matcher matcher,
                                 GateLog* log = nullptr);

/// Matches the landmarks that a keyframe sees to a frame by appearance alone (words, tight gate,
/// ratio test) and traces the matches. Returns the landmark of each feature of the frame; invalid =
/// none.
std::vector<LandmarkId> match_landmarks(const Keyframe& keyframe, const Query& query,
                                        const SlamContext& context, Matcher matcher);

/// The same, but a landmark is compared with all features of the frame, or all those with its
/// label, instead of those under the same vocabulary node. Void does not count as a label. @pre
/// where is not kNone
std::vector<LandmarkId> match_landmarks_widely(const Keyframe& keyframe, const Query& query,
                                               const SlamContext& context, Matcher matcher,
                                               WiderSearch where);

/// A search for landmarks in the current frame, where they should appear.
struct ProjectionSearch {
  const Query& query;
  std::span<const ProjectionTarget> targets;
  std::span<const LandmarkId> landmarks;  ///< of each target
  std::span<const std::uint8_t> taken;    ///< as in match_by_projection()
  ProjectionGate gate;
};

/// Returns the feature that each target matches, or -1, and traces the matches.
std::vector<std::int32_t> find_landmarks(const ProjectionSearch& search, const SlamContext& context,
                                         Matcher matcher);

/// Pairs that match_by_projection() accepted.
struct ProjectionPairs {
  KeyframeId seen_in;  ///< keyframe that owns the features; invalid = the current frame
  const Features& features;
  std::span<const ProjectionTarget> targets;
  std::span<const std::int32_t> found;         ///< per target
  std::span<const LandmarkId> landmarks;       ///< of each target
  std::span<const std::uint32_t> others = {};  ///< feature that supplied each target's descriptor;
                                               ///< empty = the landmarks' own descriptors
};
/// Records them if the context has a trace.
void trace_projection(const SlamContext& context, Matcher matcher, const ProjectionPairs& pairs);

/// Pairs that match_by_words() accepted between a keyframe and another keyframe or the current
/// frame.
struct WordPairs {
  KeyframeId a;
  const Features& features_a;
  std::span<const LandmarkId> landmarks_a;  ///< empty = none are used
  KeyframeId b;                             ///< invalid = the current frame
  const Features& features_b;
  std::span<const FeatureMatch> matches;
};
/// Records them if the context has a trace.
void trace_words(const SlamContext& context, Matcher matcher, const WordPairs& pairs);

}  // namespace mh
