// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "bench/audit/query_audit.hpp"
#include "bench/audit/true_map.hpp"
#include "slam/pipeline/probe.hpp"

namespace mh {

/// The outcome with one keyframe as the only candidate.
struct TrialOutcome {
  RelocalizationStage stage = RelocalizationStage::kNone;
  bool correct = false;
};

/// Outcomes known so far for one query under one xi and void policy, the only settings that affect
/// them: for the system as it is, without false matches, and from the true pose.
struct TrialMemo {
  std::map<KeyframeId, TrialOutcome> plain, without_false, with_true_pose;
  std::optional<StageMatches> with_every_keyframe;  ///< matches by words, with all of them
};

/// Tries single keyframes for one query, each at most once.
class Trials {
 public:
  /// The subject of the trials; the objects given by reference must outlive them.
  struct Subject {
    const SlamState& frozen;
    const PreparedFrame& frame;  ///< with its words
    RandomStream draws;
    const TrueMap& truth;
    const TrueView& view;  ///< of the query
    std::function<bool(const SE3& world_from_camera)> is_correct;
    std::optional<SE3> camera_from_map;  ///< from the true pose; absent if unknown in this map
  };
  Trials(Subject subject, TrialMemo& memo) : subject_(std::move(subject)), memo_(memo) {}

  const TrialOutcome& outcome(KeyframeId keyframe);
  bool solves(KeyframeId keyframe) { return outcome(keyframe).correct; }
  bool solves_without_false(KeyframeId keyframe);
  bool solves_with_true_pose(KeyframeId keyframe);

 private:
  const TrialOutcome& known(std::map<KeyframeId, TrialOutcome>& memo, KeyframeId keyframe,
                            const std::function<TrialGivens()>& givens);
  Subject subject_;
  TrialMemo& memo_;
};

/// Keyframes in the orders in which an audit tries them.
struct KeyframeOrders {
  std::span<const KeyframeId> nearest;     ///< by true distance
  std::span<const KeyframeId> co_visible;  ///< those with any co-visibility, best first
};

/// Fills in the ceilings of a query and the first cause of its failure. Tries as few keyframes as
/// possible.
/// @param audit  already has its answers and best_co_visible
void find_ceilings(Trials& trials, const KeyframeOrders& orders, QueryAudit& audit);

}  // namespace mh
