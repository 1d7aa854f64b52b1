// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "bench/audit/true_view.hpp"
#include "slam/io/fields.hpp"
#include "slam/match/trace.hpp"
#include "slam/semantics/descriptor_distance.hpp"

namespace mh {

/// The stages of relocalization that match features. kEveryKeyframe is not one of them: it matches,
/// by visual words, with every keyframe of the map, regardless of the choice of candidates.
enum class MatchStage { kWords, kGuided, kLocalMap, kEveryKeyframe };
inline constexpr MatchStage kMatchStages[] = {MatchStage::kWords, MatchStage::kGuided,
                                              MatchStage::kLocalMap, MatchStage::kEveryKeyframe};
inline constexpr std::size_t kMatchStageCount = 4;
std::string_view name(MatchStage stage);
/// nullopt: not a stage of relocalization.
std::optional<MatchStage> stage_of(Matcher matcher);

/// What is known about one end of a match.
struct MatchEnd {
  std::optional<TruePoint> point;  ///< absent if it shows no surface
  ClassId label = kVoid;           ///< as SLAM has it
};

/// Numbers of a stage's pairs whose truth is known, by the gate that decided them.
struct GateCounts {
  std::array<std::int64_t, kMatchGates> right{}, wrong{};  ///< by MatchGate

  std::int64_t kept_right() const { return right[0]; }
  std::int64_t kept_wrong() const { return wrong[0]; }
  /// Share of the kept pairs that are right; absent if none are kept.
  std::optional<double> precision() const;
  /// Share of the right pairs that were kept; absent if none are right. Each searched point pairs
  /// only with its nearest feature.
  std::optional<double> recall() const;
  GateCounts& operator+=(const GateCounts& more);
};

template <MaybeConst<GateCounts> C, class Visit>
void fields(C& counts, Visit& v) {
  auto& [right, wrong] = counts;
  v("right", right);
  v("wrong", wrong);
}

/// What equation 2 changed in a stage.
struct XiEffect {
  // Right pairs that are not kept but would be kept at xi = 1, counted by what removed them;
  // `another` stands for a pair that xi favors, or for the check of rotations.
  std::int64_t lost_to_threshold = 0, lost_to_ratio = 0, lost_to_another = 0;
  // The same pairs, counted by why their labels differ: a label is void, an end is within
  // kBorder_px of another class, or, in all other cases, a label must be wrong. Pairs with equal
  // labels are not counted here: they were lost because another pair changed.
  std::int64_t lost_by_void = 0, lost_at_border = 0, lost_by_label_error = 0;
  std::int64_t right_gained = 0;  ///< kept, but would not be kept at xi = 1
  std::int64_t wrong_removed = 0, wrong_gained = 0;
  // Pairs kept at xi = 1 whose labels differ.
  std::int64_t right_differ = 0, wrong_differ = 0;

  std::int64_t right_lost() const { return lost_to_threshold + lost_to_ratio + lost_to_another; }
  XiEffect& operator+=(const XiEffect& more);
};

template <MaybeConst<XiEffect> E, class Visit>
void fields(E& effect, Visit& v) {
  auto& [lost_to_threshold, lost_to_ratio, lost_to_another, lost_by_void, lost_at_border,
         lost_by_label_error, right_gained, wrong_removed, wrong_gained, right_differ,
         wrong_differ] = effect;
  v("right_lost_to_threshold", lost_to_threshold);
  v("right_lost_to_ratio", lost_to_ratio);
  v("right_lost_to_another", lost_to_another);
  v("right_lost_by_void", lost_by_void);
  v("right_lost_at_border", lost_at_border);
  v("right_lost_by_label_error", lost_by_label_error);
  v("right_gained", right_gained);
  v("wrong_removed", wrong_removed);
  v("wrong_gained", wrong_gained);
  v("right_differ", right_differ);
  v("wrong_differ", wrong_differ);
}

/// One stage's matches.
struct StageMatches {
  GateCounts with_xi, without_xi;
  XiEffect xi;
  StageMatches& operator+=(const StageMatches& more);
};

template <MaybeConst<StageMatches> M, class Visit>
void fields(M& matches, Visit& v) {
  auto& [with_xi, without_xi, xi] = matches;
  v("with_xi", with_xi);
  v("without_xi", without_xi);
  v("xi", xi);
}
using MatchAudit = std::array<StageMatches, kMatchStageCount>;
void add(const MatchAudit& more, MatchAudit& sum);

/// The two ends of the match that was decided on: the frame's feature, and the map's point.
using EndsOf = std::function<std::pair<MatchEnd, MatchEnd>(const MatchDecision&)>;

/// Compares the decisions of one step with the truth. Pairs with an end that shows no surface are
/// left out.
/// @param policy  how void is treated by equation 2
MatchAudit audit_matches(const DecisionTrace& decisions, const EndsOf& ends_of, VoidPolicy policy);

}  // namespace mh
