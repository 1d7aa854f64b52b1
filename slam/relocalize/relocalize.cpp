// SPDX-License-Identifier: Apache-2.0
#include "slam/relocalize/relocalize.hpp"

#include <algorithm>

#include "slam/config/slam.hpp"
#include "slam/match/expect.hpp"

namespace mh {
namespace {

constexpr std::size_t kNeighbors = 10;

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

using Attempt = CandidateAttempt;

/// Relocalizes against one candidate keyframe.
class CandidateTrial {
 public:
  CandidateTrial(const Query& query, const SlamContext& context, PlaceMatchers matchers)
      : query_(query), context_(context), matchers_(matchers) {}

  Attempt run(KeyframeId candidate, RandomStream stream) {
    Attempt attempt;
    const Keyframe& keyframe = context_.map.at(candidate);
    const MatchConfig& match = context_.config.match;
    const RelocalizeConfig& config = context_.config.relocalize;
    attempt.landmarks = match_landmarks(keyframe, query_, context_, matchers_.words);
    attempt.inliers =
        static_cast<int>(std::count_if(attempt.landmarks.begin(), attempt.landmarks.end(),
                                       [](LandmarkId id) { return id.valid(); }));
    if (attempt.inliers < config.min_word_matches) return attempt;

    attempt.stage = RelocalizationStage::kPnp;
    std::vector<std::uint32_t> feature_of;
    const auto observations = observe_all(attempt.landmarks, feature_of);
    const auto pnp = solve_pnp_ransac(observations, context_.camera, config.ransac,
                                      context_.config.pose, stream);
    if (!pnp) return attempt;
    adopt(*pnp, feature_of, attempt);

    // Few inliers after PnP usually mean few word matches, not a wrong pose: search again around
    // the pose, first widely, then narrowly around the refined pose.
    attempt.stage = RelocalizationStage::kInliers;
    refine(attempt);
    for (const auto& [radius_px, max_distance] :
         {std::pair{10.0F, match.max_distance_loose},
          std::pair{4.0F, 2 * match.max_distance_loose / 3}}) {
      if (attempt.inliers >= config.min_inliers || attempt.inliers < config.ransac.min_inliers)
        break;
      search_by_pose(keyframe, radius_px, static_cast<float>(max_distance), attempt);
      refine(attempt);
    }
    if (attempt.inliers >= config.min_inliers) attempt.stage = RelocalizationStage::kVerified;
    return attempt;
  }

 private:
  std::vector<PoseObservation> observe_all(const std::vector<LandmarkId>& landmarks,
                                           std::vector<std::uint32_t>& feature_of) const {
    std::vector<PoseObservation> observations;
    for (std::uint32_t i = 0; i < landmarks.size(); ++i)
      if (landmarks[i].valid()) {
        observations.push_back(observe(context_.map.at(landmarks[i]).position_in_world,
                                       query_.features.keypoints[i], context_.camera,
                                       context_.config.features));
        feature_of.push_back(i);
      }
    return observations;
  }

  void adopt(const PoseEstimate& estimate, const std::vector<std::uint32_t>& feature_of,
             Attempt& attempt) const {
    attempt.camera_from_world = estimate.camera_from_world;
    attempt.inliers = estimate.inlier_count;
    for (std::size_t j = 0; j < feature_of.size(); ++j)
      if (estimate.inlier[j] == 0) attempt.landmarks[feature_of[j]] = LandmarkId{};
  }

  void refine(Attempt& attempt) const {
    std::vector<std::uint32_t> feature_of;
    const auto observations = observe_all(attempt.landmarks, feature_of);
    const auto estimate = estimate_pose(observations, attempt.camera_from_world, context_.camera,
                                        context_.config.pose);
    if (estimate)
      adopt(*estimate, feature_of, attempt);
    else
      attempt.inliers = 0;
  }

  void search_by_pose(const Keyframe& keyframe, float radius_px, float max_distance,
                      Attempt& attempt) {
    std::vector<std::uint8_t> taken(query_.features.size(), 0);
    std::vector<LandmarkId> known;
    for (std::size_t i = 0; i < taken.size(); ++i)
      if (attempt.landmarks[i].valid()) {
        taken[i] = 1;
        known.push_back(attempt.landmarks[i]);
      }
    std::sort(known.begin(), known.end());
    const Eigen::Vector3d camera_in_world = attempt.camera_from_world.inverse().translation();
    std::vector<ProjectionTarget> targets;
    std::vector<LandmarkId> target_landmark;
    for (std::size_t i = 0; i < keyframe.landmarks.size(); ++i) {
      const LandmarkId id = keyframe.landmarks[i];
      if (!id.valid() || std::binary_search(known.begin(), known.end(), id)) continue;
      auto target = expect(context_.map.at(id), attempt.camera_from_world, camera_in_world,
                           context_.camera, context_.config.features, radius_px);
      if (!target) continue;
      target->angle_rad = keyframe.features.keypoints[i].angle_rad;
      targets.push_back(*target);
      target_landmark.push_back(id);
    }
    const auto found = match_by_projection(targets, query_.features, query_.grid, taken,
                                           {.max_distance = max_distance, .check_angle = true},
                                           semantic_matcher(context_, matchers_.projection));
    trace_projection(context_, matchers_.projection,
                     {{}, query_.features, targets, found, target_landmark});
    for (std::size_t t = 0; t < found.size(); ++t)
      if (found[t] >= 0) attempt.landmarks[static_cast<std::size_t>(found[t])] = target_landmark[t];
  }

  const Query& query_;
  const SlamContext& context_;
  PlaceMatchers matchers_;
};

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

CandidateSelection<KeyframeId> select_keyframes(const Map& map, const AugmentedVector& query,
                                                const SemanticConfig& config) {
  // Keyframes that share nothing fail equation 3 and can be skipped.
  const std::vector<InvertedIndex::Score> scores = map.sharing(query);
  const Overlap what = query.labels.empty() ? Overlap::kWords : config.overlap;
  std::vector<KeyframeId> keyframes;
  std::vector<const InvertedIndex::Score*> of(map.keyframes().size(), nullptr);
  for (const InvertedIndex::Score& score : scores) {
    keyframes.push_back(score.keyframe);
    of[score.keyframe.value] = &score;
  }
  return select_candidates(
      std::span<const KeyframeId>(keyframes),
      [&](KeyframeId k) { return overlap(*of[k.value], what); },
      [&](KeyframeId k) { return neighborhood(map, k); },
      [&](KeyframeId k) { return of[k.value] ? of[k.value]->similarity : 0.0; }, config.alpha,
      config.beta);
}

RelocalizationResult try_candidates(const Query& query, std::span<const KeyframeId> candidates,
                                    const SlamContext& context, RandomStream stream,
                                    PlaceMatchers matchers, AttemptMemo* memo) {
  RelocalizationResult result;
  AttemptMemo own;
  AttemptMemo& known = memo != nullptr ? *memo : own;
  for (const KeyframeId candidate : candidates) {
    const auto [place, is_new] = known.try_emplace(candidate);
    if (is_new) {
      MatchCounts its_counts{};
      const SlamContext own_counts{context.camera, context.config, context.map, its_counts,
                                   context.trace};
      place->second =
          CandidateTrial(query, own_counts, matchers).run(candidate, stream.fork(candidate.value));
      place->second.counts = its_counts;
    }
    const Attempt& attempt = place->second;
    add(attempt.counts, context.counts);
    result.stage = std::max(result.stage, attempt.stage);
    if (attempt.stage != RelocalizationStage::kVerified) continue;
    result.camera_from_world = attempt.camera_from_world;
    result.landmarks = attempt.landmarks;
    result.inliers = attempt.inliers;
    result.keyframe = candidate;
    break;
  }
  return result;
}

RelocalizationResult relocalize(const Query& query, const SlamContext& context, RandomStream stream,
                                AttemptMemo* memo) {
  const SlamConfig& config = context.config;
  const auto selection = select_keyframes(context.map, query.words.vector, config.semantics);
  std::vector<KeyframeId> candidates;
  for (const auto& candidate : selection.candidates) candidates.push_back(candidate.keyframe);
  Camera lenient = context.camera;
  lenient.disparity_sigma_px =
      std::max(context.camera.disparity_sigma_px, config.relocalize.disparity_sigma_px);
  const SlamContext leniently{lenient, config, context.map, context.counts, context.trace};
  RelocalizationResult result = try_candidates(query, candidates, leniently, stream, {}, memo);
  result.candidates = {.keyframes = context.map.keyframe_count(),
                       .c1 = selection.c1,
                       .c2 = selection.c2,
                       .c3 = selection.c3,
                       .final = static_cast<int>(candidates.size()),
                       .label_mass = query.words.vector.label_mass()};
  return result;
}

}  // namespace mh
