// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/match/config.hpp"
#include "slam/match/counts.hpp"
#include "slam/match/match.hpp"

namespace mh {

/// Two views of what a matcher took for the same thing, as it came out of the matcher: before any
/// pose threw out outliers.
struct MatchedPair {
  static constexpr std::uint32_t kNone = UINT32_MAX;

  Matcher matcher{};
  KeyframeId seen_in;         ///< whose feature it is; invalid = the frame of this step
  std::uint32_t feature = 0;  ///< of the frame or of seen_in
  LandmarkId landmark;        ///< what it was paired with; invalid = a keypoint without one
  KeyframeId keyframe;        ///< whose feature lent the other descriptor (the newest keyframe's,
                              ///< when triangulating); invalid = the landmark's own, or in the
                              ///< motion model the last frame's
  std::uint32_t other_feature = kNone;  ///< of that keyframe or of the last frame
  float distance_bits = 0;              ///< after equation 2
  bool penalized = false;               ///< labels known and different
  friend bool operator==(const MatchedPair&, const MatchedPair&) = default;
};

/// Every pair that the matchers of a step accepted, in order. What is not asked for costs a test of
/// a null pointer per call of a matcher.
using MatchTrace = std::vector<MatchedPair>;

/// Notes what match_by_projection() found. No effect if trace is null.
/// @param landmarks  of each target; empty = none has one
/// @param others     feature that lent each target its descriptor; empty = the landmark's own
void trace_projection(MatchTrace* trace, Matcher matcher, KeyframeId seen_in,
                      const Features& features, std::span<const ProjectionTarget> targets,
                      std::span<const std::int32_t> found, std::span<const LandmarkId> landmarks,
                      std::span<const std::uint32_t> others, const SemanticConfig& config);

/// Notes what match_by_words() found between keyframe a (with its landmarks; empty = none counts)
/// and b, which is invalid for the frame of this step. No effect if trace is null.
void trace_words(MatchTrace* trace, Matcher matcher, KeyframeId a, const Features& features_a,
                 std::span<const LandmarkId> landmarks_a, KeyframeId b, const Features& features_b,
                 std::span<const FeatureMatch> matches, const SemanticConfig& config);

/// Notes what match_landmarks() found in the frame of this step. No effect if trace is null.
/// @param landmarks  per feature of the frame, all seen by the keyframe.
void trace_landmarks(MatchTrace* trace, Matcher matcher, const Keyframe& keyframe,
                     const Features& features, std::span<const LandmarkId> landmarks,
                     const SemanticConfig& config);

}  // namespace mh
