// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/matches.hpp"

#include <map>
#include <span>
#include <utility>
#include <vector>

namespace mh {
namespace {

/// A decision of a search with its ground truth.
struct Judged {
  const MatchDecision* decision = nullptr;
  bool right = false;
  bool differ = false;  ///< whether the labels differ, by equation 2
  bool has_void = false, at_border = false;

  bool kept() const { return decision->gate == MatchGate::kKept; }
};

/// The decisions of a search, by the point that was searched for.
using Question = std::pair<LandmarkId, std::uint32_t>;
using JudgedSearch = std::map<Question, Judged>;

void count(const JudgedSearch& search, GateCounts& counts) {
  for (const auto& [question, j] : search)
    ++(j.right ? counts.right : counts.wrong)[static_cast<std::size_t>(j.decision->gate)];
}

/// The same pair in the other search; null if the point had a different nearest feature there.
const Judged* same_pair(const Question& question, const Judged& pair, const JudgedSearch& other) {
  const auto found = other.find(question);
  if (found == other.end() || found->second.decision->feature != pair.decision->feature)
    return nullptr;
  return &found->second;
}

void note_lost(const Judged& lost, const Judged* now, XiEffect& effect) {
  if (now != nullptr && now->decision->gate == MatchGate::kThreshold)
    ++effect.lost_to_threshold;
  else if (now != nullptr && now->decision->gate == MatchGate::kRatio)
    ++effect.lost_to_ratio;
  else
    ++effect.lost_to_another;
  if (!lost.differ) return;
  if (lost.has_void)
    ++effect.lost_by_void;
  else if (lost.at_border)
    ++effect.lost_at_border;
  else
    ++effect.lost_by_label_error;
}

void compare(const JudgedSearch& with, const JudgedSearch& without, XiEffect& effect) {
  for (const auto& [question, before] : without) {
    if (!before.kept()) continue;
    if (before.differ) ++(before.right ? effect.right_differ : effect.wrong_differ);
    const Judged* now = same_pair(question, before, with);
    if (now != nullptr && now->kept()) continue;
    if (before.right)
      note_lost(before, now, effect);
    else
      ++effect.wrong_removed;
  }
  for (const auto& [question, now] : with) {
    if (!now.kept()) continue;
    const Judged* before = same_pair(question, now, without);
    if (before != nullptr && before->kept()) continue;
    ++(now.right ? effect.right_gained : effect.wrong_gained);
  }
}

JudgedSearch judge(std::span<const MatchDecision> search, const EndsOf& ends_of,
                   VoidPolicy policy) {
  JudgedSearch judged;
  for (const MatchDecision& decision : search) {
    const auto [seen, mapped] = ends_of(decision);
    if (!seen.point || !mapped.point) continue;
    judged[{decision.landmark, decision.other_feature}] = {
        .decision = &decision,
        .right = same_place(*seen.point, *mapped.point),
        .differ = labels_disagree(seen.label, mapped.label, policy),
        .has_void = seen.label == kVoid || mapped.label == kVoid,
        .at_border = seen.point->at_border || mapped.point->at_border};
  }
  return judged;
}

std::optional<double> share(std::int64_t part, std::int64_t all) {
  if (all == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

std::string_view name(MatchStage stage) {
  switch (stage) {
    case MatchStage::kWords:
      return "words";
    case MatchStage::kGuided:
      return "guided";
    case MatchStage::kLocalMap:
      return "local_map";
    case MatchStage::kEveryKeyframe:
      break;
  }
  return "every_keyframe";
}

std::optional<MatchStage> stage_of(Matcher matcher) {
  switch (matcher) {
    case Matcher::kRelocalizationWords:
      return MatchStage::kWords;
    case Matcher::kRelocalizationProjection:
      return MatchStage::kGuided;
    case Matcher::kLocalMap:
      return MatchStage::kLocalMap;
    default:
      return std::nullopt;
  }
}

std::optional<double> GateCounts::precision() const {
  return share(kept_right(), kept_right() + kept_wrong());
}

std::optional<double> GateCounts::recall() const {
  std::int64_t all = 0;
  for (const std::int64_t n : right) all += n;
  return share(kept_right(), all);
}

GateCounts& GateCounts::operator+=(const GateCounts& more) {
  for (std::size_t g = 0; g < kMatchGates; ++g) {
    right[g] += more.right[g];
    wrong[g] += more.wrong[g];
  }
  return *this;
}

XiEffect& XiEffect::operator+=(const XiEffect& more) {
  std::vector<std::int64_t> added;
  const auto take = [&](const char*, std::int64_t value) { added.push_back(value); };
  fields(more, take);
  std::size_t next = 0;
  const auto put = [&](const char*, std::int64_t& value) { value += added[next++]; };
  fields(*this, put);
  return *this;
}

StageMatches& StageMatches::operator+=(const StageMatches& more) {
  with_xi += more.with_xi;
  without_xi += more.without_xi;
  xi += more.xi;
  return *this;
}

void add(const MatchAudit& more, MatchAudit& sum) {
  for (std::size_t s = 0; s < sum.size(); ++s) sum[s] += more[s];
}

MatchAudit audit_matches(const DecisionTrace& decisions, const EndsOf& ends_of, VoidPolicy policy) {
  MatchAudit audit;
  const std::span<const MatchDecision> all(decisions);
  const auto end_of = [&](std::size_t begin, bool with_xi) {
    std::size_t end = begin;
    while (end < all.size() && all[end].with_xi == with_xi) ++end;
    return end;
  };
  for (std::size_t begin = 0; begin < all.size();) {
    // Each search is traced twice: as it was, then as it would have been at xi = 1.
    const std::size_t middle = end_of(begin, true), end = end_of(middle, false);
    if (const auto stage = stage_of(all[begin].matcher)) {
      StageMatches& of_stage = audit[static_cast<std::size_t>(*stage)];
      const JudgedSearch with = judge(all.subspan(begin, middle - begin), ends_of, policy);
      const JudgedSearch without = judge(all.subspan(middle, end - middle), ends_of, policy);
      count(with, of_stage.with_xi);
      count(without, of_stage.without_xi);
      compare(with, without, of_stage.xi);
    }
    begin = end;
  }
  return audit;
}

}  // namespace mh
