// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/trials.hpp"

#include <algorithm>

namespace mh {

const TrialOutcome& Trials::known(std::map<KeyframeId, TrialOutcome>& memo, KeyframeId keyframe,
                                  const std::function<TrialGivens()>& givens) {
  const auto [place, is_new] = memo.try_emplace(keyframe);
  if (is_new) {
    const Probe tried = probe(keyframe, subject_.frozen, subject_.frame, subject_.draws, givens());
    place->second = {tried.stage,
                     tried.world_from_camera && subject_.is_correct(*tried.world_from_camera)};
  }
  return place->second;
}

const TrialOutcome& Trials::outcome(KeyframeId keyframe) {
  return known(memo_.plain, keyframe, [] { return TrialGivens(); });
}

bool Trials::solves_without_false(KeyframeId keyframe) {
  const auto is_right = [this](std::uint32_t feature, LandmarkId landmark) {
    const auto& seen = subject_.view.points[feature];
    const auto& mapped = subject_.truth.landmarks[landmark.value];
    return seen && mapped && same_place(*seen, *mapped);
  };
  return known(memo_.without_false, keyframe, [&] { return TrialGivens{.allows = is_right}; })
      .correct;
}

bool Trials::solves_with_true_pose(KeyframeId keyframe) {
  if (!subject_.camera_from_map) return false;
  return known(memo_.with_true_pose, keyframe,
               [&] { return TrialGivens{.camera_from_world = subject_.camera_from_map}; })
      .correct;
}

namespace {

FirstCause first_cause(Trials& trials, const KeyframeOrders& orders, const QueryAudit& audit) {
  if (audit.first_correct) return FirstCause::kNone;
  if (audit.by_any) return FirstCause::kWrongCandidates;
  if (audit.best_co_visible < kInSight) return FirstCause::kNothingInSight;
  const bool enough_matches = std::ranges::any_of(orders.nearest, [&](KeyframeId k) {
    return trials.outcome(k).stage > RelocalizationStage::kMatches;
  });
  if (!enough_matches) return FirstCause::kFewMatches;
  return audit.first_answered ? FirstCause::kFalseAnswer : FirstCause::kFewInliers;
}

}  // namespace

void find_ceilings(Trials& trials, const KeyframeOrders& orders, QueryAudit& audit) {
  const auto nearest = orders.nearest.first(std::min(kNearest, orders.nearest.size()));
  const auto solves = [&](KeyframeId k) { return trials.solves(k); };
  audit.by_nearest = std::ranges::any_of(nearest, solves);
  audit.by_any =
      audit.first_correct || audit.by_nearest || std::ranges::any_of(orders.nearest, solves);
  audit.without_false = audit.by_any || std::ranges::any_of(orders.co_visible, [&](KeyframeId k) {
                          return trials.solves_without_false(k);
                        });
  audit.with_true_pose = audit.by_any || std::ranges::any_of(orders.co_visible, [&](KeyframeId k) {
                           return trials.solves_with_true_pose(k);
                         });
  audit.cause = first_cause(trials, orders, audit);
}

}  // namespace mh
