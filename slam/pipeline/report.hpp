// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/core/se3.hpp"

namespace mh {

enum class TrackStatus { kInitialized, kTracked, kRelocalized, kLost };
std::string_view name(TrackStatus status);

/// Where an attempt to relocalize ended.
enum class RelocalizationStage { kNone, kNoCandidate, kMatches, kPnp, kInliers, kVerified };
std::string_view name(RelocalizationStage stage);

/// The places where descriptors are compared.
enum class Matcher { kMotionModel, kReferenceKeyframe, kLocalMap, kTriangulation, kFusion, kRelocalizationWords, kRelocalizationProjection, kCount };
std::string_view name(Matcher matcher);

/// What equation 2 did in one matcher during one step.
struct MatcherCounts {
  std::int64_t compared = 0;         ///< descriptor pairs
  std::int64_t penalised = 0;        ///< of them, labels known and different: distance times xi
  std::int64_t rejected_by_xi = 0;   ///< best pairs under the threshold before xi, over it after
  std::int64_t ratio_helped = 0;     ///< pairs that pass the ratio test only because xi inflated the second best
  MatcherCounts& operator+=(const MatcherCounts& other);
};
using MatchCounts = std::array<MatcherCounts, static_cast<std::size_t>(Matcher::kCount)>;

/// Keyframes left after each step of Algorithm 1 (C1, C2, C3 before the beta test, final).
struct CandidateCounts {
  int keyframes = 0;   ///< in the map
  int c1 = 0, c2 = 0, c3 = 0, final = 0;
  double label_mass = 0;  ///< share of the query vector's L1 mass held by labels
};

/// All that a step hands out: plain data, no reference into the system.
struct StepReport {
  TrackStatus status = TrackStatus::kLost;
  std::optional<SE3> world_from_camera;
  int keypoints = 0;
  int inliers = 0;
  bool keyframe_added = false;
  RelocalizationStage relocalization = RelocalizationStage::kNone;
  std::optional<CandidateCounts> candidates;  ///< when relocalization was tried
  MatchCounts matches{};
};

}  // namespace mh
