// SPDX-License-Identifier: Apache-2.0
#include "slam/match/match.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace mh {
namespace {

/// Rotations between matched keypoints, in bins of 12 degrees: true matches share one rotation, so
/// only the three fullest bins are kept (and only those with at least a tenth as many matches as
/// the fullest).
class RotationHistogram {
 public:
  void add(float from_rad, float to_rad) { ++count_[bin(from_rad, to_rad)]; }
  void find_dominant() {
    std::array<std::size_t, kBins> order{};
    for (std::size_t i = 0; i < kBins; ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return count_[x] > count_[y]; });
    for (std::size_t i = 0; i < 3; ++i)
      dominant_[order[i]] = count_[order[i]] * 10 >= count_[order[0]];
  }
  bool keeps(float from_rad, float to_rad) const { return dominant_[bin(from_rad, to_rad)]; }

 private:
  static constexpr std::size_t kBins = 30;
  static std::size_t bin(float from_rad, float to_rad) {
    constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
    float turn = (to_rad - from_rad) / kTurn;
    turn -= std::floor(turn);
    return static_cast<std::size_t>(std::lround(turn * kBins)) % kBins;
  }
  std::array<int, kBins> count_{};
  std::array<bool, kBins> dominant_{};
};

/// The pairs of one search in a matcher's log, if it keeps one.
class SearchLog {
 public:
  explicit SearchLog(GateLog* log) : log_(log), begin_(log == nullptr ? 0 : log->size()) {}
  void add(std::uint32_t asked, const SemanticMatcher::Best& best, bool accepted,
           float max_distance) {
    if (log_ == nullptr || best.index == UINT32_MAX) return;
    const MatchGate refused =
        best.first.semantic > max_distance ? MatchGate::kThreshold : MatchGate::kRatio;
    log_->push_back({asked, best.index, accepted ? MatchGate::kKept : refused});
  }
  /// Records `gate` for the pairs that it has just removed: those for which `kept` is now false.
  template <class Kept>
  void settle(MatchGate gate, Kept kept) {
    if (log_ == nullptr) return;
    for (std::size_t i = begin_; i < log_->size(); ++i)
      if ((*log_)[i].gate == MatchGate::kKept && !kept((*log_)[i])) (*log_)[i].gate = gate;
  }

 private:
  GateLog* log_;
  std::size_t begin_;
};

}  // namespace

bool SemanticMatcher::accept(const Best& best, float max_distance, float ratio) {
  counts_.compared += best.compared;
  counts_.penalized += best.penalized;
  if (best.index == UINT32_MAX) return false;
  if (best.first.semantic > max_distance) {
    counts_.rejected_by_xi += best.first.plain <= max_distance;
    return false;
  }
  if (ratio >= 1.0F) return true;
  if (best.first.semantic > ratio * best.second.semantic) return false;
  counts_.ratio_helped += best.first.plain > ratio * best.second.plain;
  return true;
}

std::vector<std::int32_t> match_by_projection(std::span<const ProjectionTarget> targets,
                                              const Features& features, const FeatureGrid& grid,
                                              std::span<const std::uint8_t> taken,
                                              const ProjectionGate& gate, SemanticMatcher matcher) {
  std::vector<std::int32_t> match(targets.size(), -1);
  std::vector<std::int32_t> owner(features.size(), -1);
  std::vector<float> owner_distance(features.size(), 0.0F);
  SearchLog log(matcher.log());
  const auto is_match = [&](const GatedPair& pair) {
    return match[pair.asked] == static_cast<std::int32_t>(pair.feature);
  };

  for (std::size_t t = 0; t < targets.size(); ++t) {
    const ProjectionTarget& target = targets[t];
    SemanticMatcher::Best best;
    grid.for_each_near(
        target.u_px, target.v_px, target.radius_px, [&](const FeatureGrid::Entry& k) {
          if (k.octave < target.min_octave || k.octave > target.max_octave ||
              std::abs(k.u_px - target.u_px) > target.radius_px ||
              std::abs(k.v_px - target.v_px) > target.radius_px || taken[k.index] != 0)
            return;
          best.offer(k.index,
                     matcher({*target.descriptor, target.label},
                             {features.descriptors[k.index], features.keypoints[k.index].label}),
                     k.octave);
        });
    const float ratio = best.first_octave == best.second_octave ? gate.ratio : 1.0F;
    const bool accepted = matcher.accept(best, gate.max_distance, ratio);
    log.add(static_cast<std::uint32_t>(t), best, accepted, gate.max_distance);
    if (!accepted) continue;
    std::int32_t& holder = owner[best.index];
    if (holder >= 0) {
      if (owner_distance[best.index] <= best.first.semantic) continue;
      match[static_cast<std::size_t>(holder)] = -1;
    }
    holder = static_cast<std::int32_t>(t);
    owner_distance[best.index] = best.first.semantic;
    match[t] = static_cast<std::int32_t>(best.index);
  }

  log.settle(MatchGate::kTaken, is_match);

  if (gate.check_angle) {
    RotationHistogram histogram;
    for (std::size_t t = 0; t < targets.size(); ++t)
      if (match[t] >= 0 && targets[t].angle_rad >= 0)
        histogram.add(targets[t].angle_rad,
                      features.keypoints[static_cast<std::size_t>(match[t])].angle_rad);
    histogram.find_dominant();
    for (std::size_t t = 0; t < targets.size(); ++t)
      if (match[t] >= 0 && targets[t].angle_rad >= 0 &&
          !histogram.keeps(targets[t].angle_rad,
                           features.keypoints[static_cast<std::size_t>(match[t])].angle_rad))
        match[t] = -1;
    log.settle(MatchGate::kRotation, is_match);
  }
  return match;
}

std::vector<FeatureMatch> match_by_words(
    const WordView& view_a, const WordView& view_b, const WordGate& gate, SemanticMatcher matcher,
    const std::function<bool(std::uint32_t, std::uint32_t)>& compatible) {
  const Features& a = view_a.features;
  const Features& b = view_b.features;
  std::vector<std::int32_t> owner(b.size(), -1);
  std::vector<float> owner_distance(b.size(), 0.0F);
  SearchLog log(matcher.log());

  const auto& by_a = view_a.words.by_node;
  const auto& by_b = view_b.words.by_node;
  for (std::size_t i = 0, j = 0; i < by_a.size() && j < by_b.size();) {
    if (by_a[i].first < by_b[j].first) {
      ++i;
      continue;
    }
    if (by_b[j].first < by_a[i].first) {
      ++j;
      continue;
    }
    std::size_t end_b = j;
    while (end_b < by_b.size() && by_b[end_b].first == by_b[j].first) ++end_b;
    for (const std::uint32_t node = by_a[i].first; i < by_a.size() && by_a[i].first == node; ++i) {
      const std::uint32_t fa = by_a[i].second;
      if (view_a.use[fa] == 0) continue;
      SemanticMatcher::Best best;
      for (std::size_t n = j; n < end_b; ++n) {
        const std::uint32_t fb = by_b[n].second;
        if (view_b.use[fb] == 0 || (compatible && !compatible(fa, fb))) continue;
        best.offer(fb,
                   matcher({a.descriptors[fa], a.keypoints[fa].label},
                           {b.descriptors[fb], b.keypoints[fb].label}),
                   0);
      }
      const bool accepted = matcher.accept(best, gate.max_distance, gate.ratio);
      log.add(fa, best, accepted, gate.max_distance);
      if (!accepted) continue;
      if (owner[best.index] >= 0 && owner_distance[best.index] <= best.first.semantic) continue;
      owner[best.index] = static_cast<std::int32_t>(fa);
      owner_distance[best.index] = best.first.semantic;
    }
    j = end_b;
  }
  log.settle(MatchGate::kTaken, [&](const GatedPair& pair) {
    return owner[pair.feature] == static_cast<std::int32_t>(pair.asked);
  });

  RotationHistogram histogram;
  for (std::uint32_t fb = 0; fb < owner.size(); ++fb)
    if (owner[fb] >= 0)
      histogram.add(a.keypoints[static_cast<std::size_t>(owner[fb])].angle_rad,
                    b.keypoints[fb].angle_rad);
  histogram.find_dominant();
  std::vector<FeatureMatch> matches;
  for (std::uint32_t fb = 0; fb < owner.size(); ++fb)
    if (owner[fb] >= 0 &&
        histogram.keeps(a.keypoints[static_cast<std::size_t>(owner[fb])].angle_rad,
                        b.keypoints[fb].angle_rad))
      matches.push_back({static_cast<std::uint32_t>(owner[fb]), fb});
  log.settle(MatchGate::kRotation, [&](const GatedPair& pair) {
    return histogram.keeps(a.keypoints[pair.asked].angle_rad, b.keypoints[pair.feature].angle_rad);
  });
  return matches;
}

}  // namespace mh
