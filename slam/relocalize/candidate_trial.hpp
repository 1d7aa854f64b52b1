// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <tuple>
#include <vector>

#include "slam/config/semantics.hpp"
#include "slam/core/random.hpp"
#include "slam/core/relocalization_stage.hpp"
#include "slam/match/context.hpp"

namespace mh {

/// The matchers that a search reports under: relocalization and loop closing are counted
/// separately.
struct PlaceMatchers {
  Matcher words = Matcher::kRelocalizationWords;
  Matcher projection = Matcher::kRelocalizationProjection;
};

/// The settings that a trial depends on and that may differ between queries. If they are equal, the
/// result of an earlier trial can be reused.
using TrialKey = std::tuple<double, bool, WiderSearch, double>;
inline TrialKey trial_key(const SemanticConfig& s) {
  return {s.xi, s.void_is_a_label, s.wider_search, s.min_agreement};
}

/// Result of trying one candidate.
struct CandidateAttempt {
  RelocalizationStage stage = RelocalizationStage::kMatches;
  SE3 camera_from_world;
  std::vector<LandmarkId> landmarks;  ///< per feature
  int inliers = 0;
  MatchCounts counts{};  ///< of this attempt alone
};

/// Ground truth with which an audit finds what limits a trial. Empty in normal runs.
struct TrialGivens {
  /// Which matches to keep; others are dropped as soon as they are found. Empty: all.
  std::function<bool(std::uint32_t feature, LandmarkId landmark)> allows = {};
  /// The searches guided by a pose start from this one, without matches by words.
  std::optional<SE3> camera_from_world = {};
};

/// Tries one candidate keyframe by the rules of RelocalizeConfig::acceptance.
///
/// `ours`: matches by words, PnP in RANSAC with depth, refinement; below min_inliers, two searches
/// guided by the pose, however few inliers it has.
///
/// `orb_slam2`, as in R. Mur-Artal and J. D. Tardos, ORB-SLAM2 (IEEE T-RO 33(5), 2017), and its
/// released program: EPnP on four matches at a time, gated at chi2_mono without depth; a consensus
/// has at least half of the matches, and at least ransac.min_inliers of them; RANSAC makes as many
/// tries as ransac.confidence demands for that share of inliers (35 for a half, computed for three
/// points, as in the program). Each consensus is refined. Below min_inliers, a guided search
/// follows (10 px, 100 bits), which counts only if inliers and new matches together reach
/// min_inliers; if it leaves between 30 and min_inliers inliers, it is repeated (3 px, 64 bits).
/// One thing differs from the program: each candidate is tried to the end before the next one,
/// instead of five iterations of each in turn. This may change which candidate wins, but not
/// whether one does.
CandidateAttempt try_candidate(KeyframeId candidate, const Query& query, const SlamContext& context,
                               RandomStream stream, PlaceMatchers matchers,
                               const TrialGivens& givens = {});

}  // namespace mh
