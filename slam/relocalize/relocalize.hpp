// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "slam/core/random.hpp"
#include "slam/match/context.hpp"
#include "slam/relocalize/candidate_trial.hpp"
#include "slam/relocalize/outcome.hpp"
#include "slam/semantics/candidate_selection.hpp"

namespace mh {

struct RelocalizationResult {
  RelocalizationStage stage = RelocalizationStage::kNoCandidate;
  CandidateCounts candidates;
  std::optional<SE3> camera_from_world;
  std::vector<LandmarkId> landmarks;  ///< per feature; inliers of the pose
  int inliers = 0;
  KeyframeId keyframe;  ///< the candidate that led to the pose
};

/// N_k of equation 5: a keyframe and its best covisible ones, at most ten.
/// @param belongs  which keyframes are eligible; empty = all
std::vector<KeyframeId> neighborhood(const Map& map, KeyframeId k,
                                     const std::function<bool(KeyframeId)>& belongs = {});

/// The similarity of each keyframe, by id, with the last query for which it passed equation 4; 0 =
/// none yet (NeighborScores::kAsReleased).
using ReleasedScores = std::vector<double>;

/// Algorithm 1 over the whole map. If the query has no label members, words are counted.
/// @param released  updated and used in equation 5; null: each similarity is computed anew
CandidateSelection<KeyframeId> select_keyframes(const Map& map, const AugmentedVector& query,
                                                const SemanticConfig& config,
                                                ReleasedScores* released = nullptr);

/// Attempts of one query under one stream and one xi for the candidates tried so far: searches that
/// merely choose other candidates can reuse them.
using AttemptMemo = std::map<KeyframeId, CandidateAttempt>;

/// Tries candidate keyframes in order: matching by words, PnP with RANSAC, refinement, guided
/// search. The first success wins; `candidates` of the result stays empty. A memo saves work and
/// does not change the result.
RelocalizationResult try_candidates(const Query& query, std::span<const KeyframeId> candidates,
                                    const SlamContext& context, RandomStream stream,
                                    PlaceMatchers matchers = {}, AttemptMemo* memo = nullptr);

/// The candidates of relocalize(): select_keyframes() under RelocalizeConfig::neighbor_scores, and
/// the rules of SemanticConfig beyond the paper.
/// @param released  of earlier queries; used and updated if the settings say so. @pre not null then
CandidateSelection<KeyframeId> choose_candidates(const Map& map, const Query& query,
                                                 const SlamConfig& config,
                                                 ReleasedScores* released);

/// Tries one keyframe as relocalize() tries its candidates.
CandidateAttempt try_alone(KeyframeId candidate, const Query& query, const SlamContext& context,
                           RandomStream stream, const TrialGivens& givens = {});

/// Localizes the camera in the map without an initial guess: Algorithm 1 chooses the candidates, in
/// order of score. Depth is weighted by RelocalizeConfig::disparity_sigma_px: the pose is a
/// starting point that the local map, weighting depth as the camera does, must confirm.
/// @param released  of earlier queries; used and updated if the settings say so. @pre not null then
RelocalizationResult relocalize(const Query& query, const SlamContext& context, RandomStream stream,
                                AttemptMemo* memo = nullptr, ReleasedScores* released = nullptr);

}  // namespace mh
