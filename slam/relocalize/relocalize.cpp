// SPDX-License-Identifier: Apache-2.0
#include "slam/relocalize/relocalize.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "slam/config/slam.hpp"
#include "slam/relocalize/beyond_paper.hpp"

namespace mh {
namespace {

constexpr std::size_t kNeighbors = 10;
constexpr RelocalizationStage kLastBeforeVerified = RelocalizationStage::kInliers;

int overlap(const InvertedIndex::Score& score, Overlap what) {
  switch (what) {
    case Overlap::kLabels:
      return score.shared_labels;
    case Overlap::kAugmented:
      return score.shared_labels + score.shared_words;
    case Overlap::kWords:
      break;
  }
  return score.shared_words;
}

}  // namespace

std::vector<KeyframeId> neighborhood(const Map& map, KeyframeId k,
                                     const std::function<bool(KeyframeId)>& belongs) {
  std::vector<KeyframeId> result{k};
  for (const Keyframe::Neighbor& n : map.at(k).covisible) {
    if (result.size() > kNeighbors) break;
    if (!belongs || belongs(n.id)) result.push_back(n.id);
  }
  return result;
}

namespace {

/// Stores the similarities of the keyframes that pass equation 4, as ORB-SLAM2 does for each query.
void store(const std::vector<InvertedIndex::Score>& scores, Overlap what, double alpha,
           StaleScores& stale_scores) {
  ++stale_scores.queries;
  int most = 0;
  for (const InvertedIndex::Score& score : scores) most = std::max(most, overlap(score, what));
  for (const InvertedIndex::Score& score : scores)
    if (overlap(score, what) > alpha * most)
      stale_scores.of[score.keyframe.value] = {score.similarity, stale_scores.queries};
}

}  // namespace

KeyframeSelection select_keyframes(const Map& map, const AugmentedVector& query,
                                   const SemanticConfig& config, StaleScores* stale_scores) {
  // Keyframes that share nothing fail equation 3 and can be skipped.
  const std::vector<InvertedIndex::Score> scores = map.sharing(query);
  const Overlap what = query.labels.empty() ? Overlap::kWords : config.overlap;
  std::vector<KeyframeId> keyframes;
  std::vector<const InvertedIndex::Score*> of(map.keyframes().size(), nullptr);
  for (const InvertedIndex::Score& score : scores) {
    keyframes.push_back(score.keyframe);
    of[score.keyframe.value] = &score;
  }
  if (stale_scores != nullptr) {
    stale_scores->of.resize(map.keyframes().size());
    store(scores, what, config.alpha, *stale_scores);
  }
  SummedScores summed;
  const auto similarity = [&](KeyframeId k) {
    if (of[k.value] == nullptr) return 0.0;
    const StaleScores::Score score = stale_scores != nullptr
                                         ? stale_scores->of[k.value]
                                         : StaleScores::Score{of[k.value]->similarity};
    ++summed.terms;
    summed.weight += score.similarity;
    if (stale_scores == nullptr || score.query == stale_scores->queries) return score.similarity;
    if (score.query == 0) {
      ++summed.unscored;
    } else {
      ++summed.stale;
      summed.stale_weight += score.similarity;
      summed.stale_age += stale_scores->queries - score.query;
    }
    return score.similarity;
  };
  const auto shared = [&](KeyframeId k) { return overlap(*of[k.value], what); };
  const auto neighbors = [&](KeyframeId k) { return neighborhood(map, k); };
  CandidateSelection<KeyframeId> selection =
      select_candidates(std::span<const KeyframeId>(keyframes), shared, neighbors, similarity,
                        config.alpha, config.beta);
  return {std::move(selection), summed};
}

RelocalizationResult try_candidates(const Query& query, std::span<const KeyframeId> candidates,
                                    const SlamContext& context, RandomStream stream,
                                    PlaceMatchers matchers, AttemptMemo* memo,
                                    const IsPossible& is_possible) {
  RelocalizationResult result;
  AttemptMemo own;
  AttemptMemo& known = memo != nullptr ? *memo : own;
  for (const KeyframeId candidate : candidates) {
    const auto [place, is_new] = known.try_emplace(candidate);
    if (is_new) {
      MatchCounts its_counts{};
      const SlamContext own_counts{context.camera, context.config, context.map,
                                   its_counts,     context.trace,  context.decisions};
      place->second =
          try_candidate(candidate, query, own_counts, stream.fork(candidate.value), matchers);
      place->second.counts = its_counts;
    }
    const CandidateAttempt& attempt = place->second;
    add(attempt.counts, context.counts);
    const bool found = attempt.stage == RelocalizationStage::kVerified &&
                       (!is_possible ||
                        is_possible({context.map.at(candidate).origin, attempt.camera_from_world}));
    result.stage = std::max(result.stage,
                            found ? attempt.stage : std::min(attempt.stage, kLastBeforeVerified));
    if (!found) continue;
    result.camera_from_world = attempt.camera_from_world;
    result.landmarks = attempt.landmarks;
    result.inliers = attempt.inliers;
    result.keyframe = candidate;
    break;
  }
  return result;
}

namespace {

/// The camera with the depth uncertainty that is assumed while candidates are tried.
Camera lenient(const Camera& camera, const RelocalizeConfig& config) {
  Camera camera_of_trials = camera;
  if (config.acceptance == Acceptance::kOurs)
    camera_of_trials.disparity_sigma_px =
        std::max(camera.disparity_sigma_px, config.disparity_sigma_px);
  return camera_of_trials;
}

/// Multiplies each score by a power of size_agreement(), and sorts again.
void prefer_near(std::vector<Candidate<KeyframeId>>& candidates, const Map& map,
                 const Features& features, double power) {
  for (Candidate<KeyframeId>& candidate : candidates)
    candidate.score *=
        std::pow(size_agreement(features, map.at(candidate.keyframe).features), power);
  std::ranges::stable_sort(candidates, std::ranges::greater{}, &Candidate<KeyframeId>::score);
}

bool is_elsewhere(const SE3& a, const SE3& b) {
  constexpr double kApart_m = 0.5, kApart_rad = 0.35;
  return (a.inverse().translation() - b.inverse().translation()).norm() > kApart_m ||
         angle_between_rad(a, b) > kApart_rad;
}

/// Tries all candidates, and returns the pose with the most inliers. If a pose elsewhere has at
/// least RelocalizeConfig::rival_share of that number, the place is ambiguous, and no pose is
/// returned.
RelocalizationResult try_rivals(const Query& query, std::span<const KeyframeId> candidates,
                                const SlamContext& context, RandomStream stream, AttemptMemo* memo,
                                const IsPossible& is_possible) {
  RelocalizationResult result;
  std::vector<RelocalizationResult> found;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    RelocalizationResult tried =
        try_candidates(query, candidates.subspan(i, 1), context, stream, {}, memo, is_possible);
    result.stage = std::max(result.stage, tried.stage);
    if (tried.camera_from_world) found.push_back(std::move(tried));
  }
  if (found.empty()) return result;
  const auto best = std::ranges::max_element(found, {}, &RelocalizationResult::inliers);
  const double rival = context.config.relocalize.rival_share * best->inliers;
  const bool has_rival = std::ranges::any_of(found, [&](const RelocalizationResult& other) {
    return other.inliers >= rival &&
           is_elsewhere(*other.camera_from_world, *best->camera_from_world);
  });
  if (!has_rival) return *best;
  result.stage = kLastBeforeVerified;
  return result;
}

}  // namespace

KeyframeSelection choose_candidates(const Map& map, const Query& query, const SlamConfig& config,
                                    StaleScores* stale_scores) {
  const NeighborScores neighbors = config.relocalize.neighbor_scores;
  StaleScores cleared;
  if (neighbors != NeighborScores::kAsReleased)
    stale_scores = neighbors == NeighborScores::kCleared ? &cleared : nullptr;
  const SemanticConfig& rules = config.semantics;
  KeyframeSelection selection = select_keyframes(map, query.words.vector, rules, stale_scores);
  const auto prefer = [&](std::vector<Candidate<KeyframeId>>& candidates) {
    if (rules.nearness > 0) prefer_near(candidates, map, query.features, rules.nearness);
  };
  prefer(selection.candidates);
  if (rules.candidates == CandidateLists::kSideBySide) {
    auto by_words = select_keyframes(map, words_alone(query.words.vector), rules).candidates;
    prefer(by_words);  // before the lists are merged: their scores have different scales
    selection.candidates = side_by_side(selection.candidates, by_words);
  }
  return selection;
}

CandidateAttempt try_alone(KeyframeId candidate, const Query& query, const SlamContext& context,
                           RandomStream stream, const TrialGivens& givens) {
  const Camera camera = lenient(context.camera, context.config.relocalize);
  const SlamContext leniently{camera,         context.config, context.map,
                              context.counts, context.trace,  context.decisions};
  return try_candidate(candidate, query, leniently, stream.fork(candidate.value), {}, givens);
}

RelocalizationResult relocalize(const Query& query, const SlamContext& context, RandomStream stream,
                                AttemptMemo* memo, StaleScores* stale_scores,
                                const IsPossible& is_possible) {
  const SlamConfig& config = context.config;
  const auto selection = choose_candidates(context.map, query, config, stale_scores);
  std::vector<KeyframeId> candidates;
  for (const auto& candidate : selection.candidates) candidates.push_back(candidate.keyframe);
  const Camera camera = lenient(context.camera, config.relocalize);
  const SlamContext leniently{camera,         config,        context.map,
                              context.counts, context.trace, context.decisions};
  RelocalizationResult result =
      config.relocalize.rival_share > 0
          ? try_rivals(query, candidates, leniently, stream, memo, is_possible)
          : try_candidates(query, candidates, leniently, stream, {}, memo, is_possible);
  result.candidates = {.keyframes = context.map.keyframe_count(),
                       .c1 = selection.c1,
                       .c2 = selection.c2,
                       .c3 = selection.c3,
                       .final = static_cast<int>(candidates.size()),
                       .label_mass = query.words.vector.label_mass(),
                       .summed = selection.summed};
  return result;
}

}  // namespace mh
