// SPDX-License-Identifier: Apache-2.0
#include "slam/core/match_counts.hpp"

namespace mh {

std::string_view name(Matcher matcher) {
  switch (matcher) {
    case Matcher::kMotionModel:
      return "motion_model";
    case Matcher::kReferenceKeyframe:
      return "reference_keyframe";
    case Matcher::kLocalMap:
      return "local_map";
    case Matcher::kTriangulation:
      return "triangulation";
    case Matcher::kFusion:
      return "fusion";
    case Matcher::kRelocalizationWords:
      return "relocalization_words";
    case Matcher::kRelocalizationProjection:
      return "relocalization_projection";
    case Matcher::kLoop:
      return "loop";
    case Matcher::kCount:
      break;
  }
  return "?";
}

MatcherCounts& MatcherCounts::operator+=(const MatcherCounts& other) {
  compared += other.compared;
  penalized += other.penalized;
  rejected_by_xi += other.rejected_by_xi;
  ratio_helped += other.ratio_helped;
  return *this;
}

void add(const MatchCounts& more, MatchCounts& counts) {
  for (std::size_t m = 0; m < counts.size(); ++m) counts[m] += more[m];
}

void add(const std::optional<MatchCounts>& more, std::optional<MatchCounts>& counts) {
  if (!more) return;
  if (!counts) counts.emplace();
  add(*more, *counts);
}

}  // namespace mh
