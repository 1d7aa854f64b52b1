// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/match/counts.hpp"

namespace mh {

/// Two views that a matcher took for the same point, as the matcher returned them: before any pose
/// estimate rejected outliers.
struct MatchedPair {
  static constexpr std::uint32_t kNone = UINT32_MAX;

  Matcher matcher{};
  KeyframeId seen_in;         ///< owner of the feature; invalid = the current frame
  std::uint32_t feature = 0;  ///< of the current frame or of seen_in
  LandmarkId landmark;        ///< the landmark it was matched to; invalid = a keypoint without one
  KeyframeId keyframe;        ///< owner of the feature that supplied the other descriptor (the
                              ///< newest keyframe when triangulating); invalid = the landmark's
                              ///< own, or in the motion model the last frame's
  std::uint32_t other_feature = kNone;  ///< of that keyframe or of the last frame
  float distance_bits = 0;              ///< after equation 2
  bool penalized = false;               ///< labels known and different
  friend bool operator==(const MatchedPair&, const MatchedPair&) = default;
};

/// Every pair that the matchers of a step accepted, in order. A disabled trace costs one
/// null-pointer test per matcher call.
using MatchTrace = std::vector<MatchedPair>;

}  // namespace mh
