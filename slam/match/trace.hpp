// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/core/match_counts.hpp"
#include "slam/match/gate.hpp"

namespace mh {

/// Two features that a matcher took for the same point, as the matcher returned them: before any
/// pose estimate rejected outliers.
struct MatchedPair {
  static constexpr std::uint32_t kNone = UINT32_MAX;

  Matcher matcher{};
  KeyframeId seen_in;         ///< owner of the feature; invalid = the current frame
  std::uint32_t feature = 0;  ///< of the current frame or of seen_in
  LandmarkId landmark;        ///< the landmark it was matched to; invalid = a keypoint without one
  KeyframeId keyframe;  ///< owner of the feature that supplied the other descriptor (the newest
                        ///< keyframe when triangulating); invalid = that descriptor is the
                        ///< landmark's own or, in the motion model, from the last frame
  std::uint32_t other_feature = kNone;  ///< of that keyframe or of the last frame
  float distance_bits = 0;              ///< after equation 2
  bool penalized = false;               ///< the labels are known and differ
  friend bool operator==(const MatchedPair&, const MatchedPair&) = default;
};

/// Every pair that the matchers of a step accepted, in order. A disabled trace costs one
/// null-pointer test per matcher call.
using MatchTrace = std::vector<MatchedPair>;

/// A pair that a search for the map's points in the current frame considered, kept or not. Each
/// search is traced twice: first as it was, then as it would have been without equation 2 (xi = 1).
/// The second run affects no results.
struct MatchDecision {
  Matcher matcher{};
  bool with_xi = true;
  MatchGate gate = MatchGate::kKept;
  std::uint32_t feature = 0;  ///< of the current frame
  LandmarkId landmark;
  KeyframeId keyframe;  ///< owner of the feature that was compared; invalid = the landmark's own
  std::uint32_t other_feature = MatchedPair::kNone;  ///< of that keyframe
};

/// Decisions of a step, in order. They are made by relocalization, which searches by words and by
/// pose, and by the search in the local map.
using DecisionTrace = std::vector<MatchDecision>;

}  // namespace mh
