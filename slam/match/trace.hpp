// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/match/counts.hpp"

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

}  // namespace mh
