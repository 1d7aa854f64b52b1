// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "slam/core/random.hpp"
#include "slam/core/relocalization_stage.hpp"
#include "slam/match/context.hpp"
#include "slam/relocalize/candidate_counts.hpp"
#include "slam/relocalize/candidate_trial.hpp"
#include "slam/relocalize/stale_scores.hpp"
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

/// N_k of equation 5: a keyframe and its best covisible keyframes, at most ten of them.
/// @param belongs  which keyframes are eligible; empty = all
std::vector<KeyframeId> neighborhood(const Map& map, KeyframeId k,
                                     const std::function<bool(KeyframeId)>& belongs = {});

/// Algorithm 1's choice, and which queries computed the similarities that it summed.
struct KeyframeSelection : CandidateSelection<KeyframeId> {
  SummedScores summed;
};

/// Algorithm 1 over the whole map. If the query's vector holds no label, equation 3 counts words,
/// whatever `overlap` says.
/// @param stale_scores  first receives this query's similarities, then supplies those of equation
/// 5; null: each similarity is computed for this query
KeyframeSelection select_keyframes(const Map& map, const AugmentedVector& query,
                                   const SemanticConfig& config,
                                   StaleScores* stale_scores = nullptr);

/// The attempts at one query so far, by candidate, under one stream and one trial_key(). Searches
/// that differ only in which candidates they choose can reuse them.
using AttemptMemo = std::map<KeyframeId, CandidateAttempt>;

/// Whether a pose is possible, given what is known about the camera's place. Empty: any pose is.
using IsPossible = std::function<bool(const MapPose& pose)>;

/// Tries candidate keyframes in order: matching by words, PnP with RANSAC, refinement, guided
/// search. The first success at a possible pose wins; `candidates` of the result stays empty. A
/// memo saves work and does not change the result.
RelocalizationResult try_candidates(const Query& query, std::span<const KeyframeId> candidates,
                                    const SlamContext& context, RandomStream stream,
                                    PlaceMatchers matchers = {}, AttemptMemo* memo = nullptr,
                                    const IsPossible& is_possible = {});

/// Chooses the candidates that relocalize() tries: select_keyframes(), with neighbors scored
/// according to RelocalizeConfig::neighbor_scores, then the rules `nearness` and `candidates` of
/// SemanticConfig.
/// @param stale_scores  of earlier queries. Read and updated only under
/// NeighborScores::kAsReleased, and must then not be null
KeyframeSelection choose_candidates(const Map& map, const Query& query, const SlamConfig& config,
                                    StaleScores* stale_scores);

/// Tries one keyframe as relocalize() tries its candidates.
CandidateAttempt try_alone(KeyframeId candidate, const Query& query, const SlamContext& context,
                           RandomStream stream, const TrialGivens& givens = {});

/// Localizes the camera in the map without an initial guess: Algorithm 1 chooses the candidates, in
/// order of score. With acceptance `ours`, candidates are tried at
/// RelocalizeConfig::disparity_sigma_px or the camera's own sigma, whichever is larger. The pose is
/// provisional: the caller must confirm it in the local map, at the camera's own sigma. With
/// RelocalizeConfig::rival_share, every candidate is tried.
/// @param stale_scores  of earlier queries. Read and updated only under
/// NeighborScores::kAsReleased, and must then not be null
RelocalizationResult relocalize(const Query& query, const SlamContext& context, RandomStream stream,
                                AttemptMemo* memo = nullptr, StaleScores* stale_scores = nullptr,
                                const IsPossible& is_possible = {});

}  // namespace mh
