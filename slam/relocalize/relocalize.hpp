// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/map/map.hpp"
#include "slam/match/config.hpp"
#include "slam/match/counts.hpp"
#include "slam/match/trace.hpp"
#include "slam/optimize/pose.hpp"
#include "slam/semantics/candidate_selection.hpp"

namespace mh {

struct RelocalizeConfig {
  int min_word_matches = 15;
  int min_inliers = 50;  ///< to accept a pose
  /// How far the disparity of a true pair strays (one standard deviation, beside the keypoint's own
  /// as in Camera) before the pose is refined on the local map; at least the camera's own counts.
  /// The camera's tells of one reading. Here the landmark comes from another reading (0.1 px), the
  /// pose from a handful of points (1 cm at 1.4 m: 0.2 px), and color and depth were neither taken
  /// at the same moment nor is a structured-light sensor free of warp (0.2 px): 0.3 px together,
  /// which is what pairs of real recordings show (docs/slam.md).
  double disparity_sigma_px = 0.3;
  RansacConfig ransac;
};

/// Where an attempt to relocalize ended: the farthest stage that any candidate reached and failed,
/// or kVerified.
enum class RelocalizationStage { kNone, kNoCandidate, kMatches, kPnp, kInliers, kVerified };
std::string_view name(RelocalizationStage stage);

/// Keyframes left after each step of Algorithm 1.
struct CandidateCounts {
  int keyframes = 0;           ///< in the map
  int c1 = 0, c2 = 0, c3 = 0;  ///< after equations 3, 4 and 5
  int final = 0;               ///< after equation 6
  double label_mass = 0;       ///< share of the query vector's L1 mass held by labels
};

/// A frame prepared for search: its features with index and bag of words.
struct Query {
  const Features& features;
  const FeatureGrid& grid;
  const WordIndex& words;
};

struct RelocalizationResult {
  RelocalizationStage stage = RelocalizationStage::kNoCandidate;
  CandidateCounts candidates;
  std::optional<SE3> camera_from_world;
  std::vector<LandmarkId> landmarks;  ///< per feature; inliers of the pose
  int inliers = 0;
  KeyframeId keyframe;  ///< the candidate that led to the pose
};

/// N_k of equation 5: a keyframe and its best covisible ones, ten at most.
/// @param belongs  which keyframes count at all; empty = all
std::vector<KeyframeId> neighborhood(const Map& map, KeyframeId k,
                                     const std::function<bool(KeyframeId)>& belongs = {});

/// Algorithm 1 over the whole map. Where the query has no label member, words are counted.
CandidateSelection<KeyframeId> select_keyframes(const Map& map, const AugmentedVector& query,
                                                const SemanticConfig& config);

/// Which matchers a search reports under: relocalization and loop closing count apart.
struct PlaceMatchers {
  Matcher words = Matcher::kRelocalizationWords;
  Matcher projection = Matcher::kRelocalizationProjection;
};

/// What came of trying one candidate.
struct CandidateAttempt {
  RelocalizationStage stage = RelocalizationStage::kMatches;
  SE3 camera_from_world;
  std::vector<LandmarkId> landmarks;  ///< per feature
  int inliers = 0;
  MatchCounts counts{};  ///< of this attempt alone
};

/// Attempts of one query under one stream and one xi against the candidates that were tried so far:
/// searches that merely choose other candidates need not make them again.
using AttemptMemo = std::map<KeyframeId, CandidateAttempt>;

/// Tries candidate keyframes in order: matches by words, PnP with RANSAC, refinement, guided
/// search. The first that holds wins; `candidates` of the result stays empty. A memo changes
/// nothing but the work.
RelocalizationResult try_candidates(const Query& query, std::span<const KeyframeId> candidates,
                                    const Map& map, const Camera& camera,
                                    const FeatureConfig& features, const SemanticConfig& semantics,
                                    const MatchConfig& match, const RelocalizeConfig& config,
                                    RandomStream stream, MatchCounts& counts,
                                    PlaceMatchers matchers = {}, MatchTrace* trace = nullptr,
                                    AttemptMemo* memo = nullptr);

/// Finds the camera in the map without any guess: Algorithm 1 chooses the candidates, in order of
/// score. Depth is weighed by config.disparity_sigma_px: the pose is one to begin from, which the
/// local map, weighing depth as the camera does, has to confirm.
RelocalizationResult relocalize(const Query& query, const Map& map, const Camera& camera,
                                const FeatureConfig& features, const SemanticConfig& semantics,
                                const MatchConfig& match, const RelocalizeConfig& config,
                                RandomStream stream, MatchCounts& counts,
                                MatchTrace* trace = nullptr, AttemptMemo* memo = nullptr);

}  // namespace mh
