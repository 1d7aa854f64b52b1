// SPDX-License-Identifier: Apache-2.0
#include "slam/relocalize/candidate_trial.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "slam/config/slam.hpp"
#include "slam/match/expect.hpp"
#include "slam/optimize/epnp.hpp"
#include "slam/relocalize/beyond_paper.hpp"

namespace mh {
namespace {

/// Relocalizes against one candidate keyframe.
class CandidateTrial {
 public:
  CandidateTrial(const Query& query, const SlamContext& context, PlaceMatchers matchers,
                 const TrialGivens& givens)
      : query_(query), context_(context), matchers_(matchers), givens_(givens) {}

  CandidateAttempt run(KeyframeId candidate, RandomStream stream) {
    CandidateAttempt attempt;
    const Keyframe& keyframe = context_.map.at(candidate);
    const RelocalizeConfig& config = context_.config.relocalize;
    if (givens_.camera_from_world) return search_around(*givens_.camera_from_world, keyframe);
    attempt.landmarks = allowed(match_landmarks(keyframe, query_, context_, matchers_.words));
    attempt.inliers = count(attempt.landmarks);
    if (attempt.inliers < config.min_word_matches) search_widely(keyframe, attempt);
    if (attempt.inliers < config.min_word_matches) return attempt;

    attempt.stage = RelocalizationStage::kPnp;
    if (config.acceptance == Acceptance::kOurs)
      accept_ours(keyframe, stream, attempt);
    else
      accept_as_orb_slam2(keyframe, stream, attempt);
    if (attempt.stage == RelocalizationStage::kVerified && !labels_agree(attempt))
      attempt.stage = RelocalizationStage::kInliers;
    return attempt;
  }

 private:
  std::vector<LandmarkId> allowed(std::vector<LandmarkId> landmarks) const {
    for (std::uint32_t i = 0; i < landmarks.size(); ++i)
      if (landmarks[i].valid() && !is_allowed(i, landmarks[i])) landmarks[i] = LandmarkId{};
    return landmarks;
  }

  static int count(const std::vector<LandmarkId>& landmarks) {
    return static_cast<int>(std::ranges::count_if(landmarks, &LandmarkId::valid));
  }

  void search_widely(const Keyframe& keyframe, CandidateAttempt& attempt) const {
    const WiderSearch where = context_.config.semantics.wider_search;
    if (where == WiderSearch::kNone || matchers_.words != Matcher::kRelocalizationWords) return;
    std::vector<LandmarkId> landmarks =
        allowed(match_landmarks_widely(keyframe, query_, context_, matchers_.words, where));
    const int found = count(landmarks);
    if (found <= attempt.inliers) return;
    attempt.landmarks = std::move(landmarks);
    attempt.inliers = found;
  }

  bool labels_agree(const CandidateAttempt& attempt) const {
    const double least = context_.config.semantics.min_agreement;
    return least <= 0 || label_agreement(query_.features, attempt.landmarks, context_.map) >= least;
  }

  void accept_ours(const Keyframe& keyframe, RandomStream stream, CandidateAttempt& attempt) {
    const RelocalizeConfig& config = context_.config.relocalize;
    std::vector<std::uint32_t> feature_of;
    const auto observations = observe_all(attempt.landmarks, feature_of);
    const auto pnp = solve_pnp_ransac(observations, context_.camera, config.ransac,
                                      context_.config.pose, stream);
    if (!pnp) return;
    adopt(*pnp, feature_of, attempt);

    // Few inliers after PnP usually mean few word matches, not a wrong pose: search again around
    // the pose, first widely, then narrowly around the refined pose.
    attempt.stage = RelocalizationStage::kInliers;
    refine(attempt);
    for (const auto& [radius_px, max_distance] : guided_searches()) {
      if (attempt.inliers >= config.min_inliers || attempt.inliers < config.ransac.min_inliers)
        break;
      search_by_pose(keyframe, radius_px, max_distance, attempt);
      refine(attempt);
    }
    if (attempt.inliers >= config.min_inliers) attempt.stage = RelocalizationStage::kVerified;
  }

  /// Radius (px) and threshold (bits) of each guided search.
  std::array<std::pair<float, float>, 2> guided_searches() const {
    const int loose = context_.config.match.max_distance_loose;
    return {std::pair{static_cast<float>(context_.config.relocalize.search_radius_px),
                      static_cast<float>(loose)},
            std::pair{4.0F, static_cast<float>(2 * loose / 3)}};
  }

  /// The guided searches alone, from a given pose: TrialGivens::camera_from_world.
  CandidateAttempt search_around(const SE3& camera_from_world, const Keyframe& keyframe) {
    CandidateAttempt attempt;
    attempt.stage = RelocalizationStage::kInliers;
    attempt.camera_from_world = camera_from_world;
    attempt.landmarks.resize(query_.features.size());
    for (const auto& [radius_px, max_distance] : guided_searches()) {
      search_by_pose(keyframe, radius_px, max_distance, attempt);
      refine(attempt);
      if (attempt.inliers < context_.config.relocalize.ransac.min_inliers) return attempt;
    }
    if (attempt.inliers >= context_.config.relocalize.min_inliers)
      attempt.stage = RelocalizationStage::kVerified;
    return attempt;
  }

  bool is_allowed(std::uint32_t feature, LandmarkId landmark) const {
    return !givens_.allows || givens_.allows(feature, landmark);
  }

  void accept_as_orb_slam2(const Keyframe& keyframe, RandomStream stream,
                           CandidateAttempt& attempt) {
    std::vector<std::uint32_t> feature_of;
    std::vector<PoseObservation> observations = observe_all(attempt.landmarks, feature_of);
    for (PoseObservation& o : observations) o.disparity_px = -1;
    const std::vector<LandmarkId> matched = attempt.landmarks;
    for_each_epnp_consensus(observations, context_.camera, context_.config.relocalize.ransac,
                            context_.config.pose, stream, [&](const PoseEstimate& consensus) {
                              attempt.landmarks = matched;
                              adopt(consensus, feature_of, attempt);
                              attempt.stage = RelocalizationStage::kInliers;
                              return verify_as_orb_slam2(keyframe, attempt);
                            });
  }

  /// @returns whether the pose is accepted
  bool verify_as_orb_slam2(const Keyframe& keyframe, CandidateAttempt& attempt) {
    const int enough = context_.config.relocalize.min_inliers;
    refine(attempt);
    if (attempt.inliers < context_.config.relocalize.ransac.min_inliers) return false;
    struct Search {
      int above;  ///< number of inliers that must be exceeded
      float radius_px, max_distance;
    };
    for (const Search& search : {Search{0, 10, 100}, Search{30, 3, 64}}) {
      if (attempt.inliers >= enough) break;
      if (attempt.inliers <= search.above) return false;
      const int found = search_by_pose(keyframe, search.radius_px, search.max_distance, attempt);
      if (attempt.inliers + found < enough) return false;
      refine(attempt);
    }
    if (attempt.inliers < enough) return false;
    attempt.stage = RelocalizationStage::kVerified;
    return true;
  }

  std::vector<PoseObservation> observe_all(const std::vector<LandmarkId>& landmarks,
                                           std::vector<std::uint32_t>& feature_of) const {
    return observe(query_.features, landmarks, context_.map, context_.camera,
                   context_.config.features, feature_of);
  }

  void adopt(const PoseEstimate& estimate, const std::vector<std::uint32_t>& feature_of,
             CandidateAttempt& attempt) const {
    attempt.camera_from_world = estimate.camera_from_world;
    attempt.inliers = estimate.inlier_count;
    for (std::size_t j = 0; j < feature_of.size(); ++j)
      if (estimate.inlier[j] == 0) attempt.landmarks[feature_of[j]] = LandmarkId{};
  }

  void refine(CandidateAttempt& attempt) const {
    std::vector<std::uint32_t> feature_of;
    const auto observations = observe_all(attempt.landmarks, feature_of);
    const auto estimate = estimate_pose(observations, attempt.camera_from_world, context_.camera,
                                        context_.config.pose);
    if (estimate)
      adopt(*estimate, feature_of, attempt);
    else
      attempt.inliers = 0;
  }

  /// @returns the number of landmarks that it added
  int search_by_pose(const Keyframe& keyframe, float radius_px, float max_distance,
                     CandidateAttempt& attempt) {
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
    const auto found = find_landmarks({query_,
                                       targets,
                                       target_landmark,
                                       taken,
                                       {.max_distance = max_distance, .check_angle = true}},
                                      context_, matchers_.projection);
    int added = 0;
    for (std::size_t t = 0; t < found.size(); ++t)
      if (found[t] >= 0 && is_allowed(static_cast<std::uint32_t>(found[t]), target_landmark[t])) {
        attempt.landmarks[static_cast<std::size_t>(found[t])] = target_landmark[t];
        ++added;
      }
    return added;
  }

  const Query& query_;
  const SlamContext& context_;
  PlaceMatchers matchers_;
  const TrialGivens& givens_;
};

}  // namespace

CandidateAttempt try_candidate(KeyframeId candidate, const Query& query, const SlamContext& context,
                               RandomStream stream, PlaceMatchers matchers,
                               const TrialGivens& givens) {
  return CandidateTrial(query, context, matchers, givens).run(candidate, stream);
}

}  // namespace mh
