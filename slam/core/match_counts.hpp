// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "slam/io/fields.hpp"

namespace mh {

/// The stages that compare descriptors.
enum class Matcher {
  kMotionModel,
  kReferenceKeyframe,
  kLocalMap,
  kTriangulation,
  kFusion,
  kRelocalizationWords,
  kRelocalizationProjection,
  kLoop,
  kCount
};
std::string_view name(Matcher matcher);

/// Effect of equation 2 in one matcher during one step.
struct MatcherCounts {
  std::int64_t compared = 0;  ///< descriptor pairs
  std::int64_t penalized =
      0;  ///< those whose labels are known and differ: xi multiplies their distance
  std::int64_t rejected_by_xi =
      0;  ///< best pairs whose distance was below the threshold before xi and is above it after
  std::int64_t ratio_helped =
      0;  ///< pairs that pass the ratio test only because xi inflated the second best
  MatcherCounts& operator+=(const MatcherCounts& other);
};

template <MaybeConst<MatcherCounts> C, class Visit>
void fields(C& counts, Visit& v) {
  auto& [compared, penalized, rejected_by_xi, ratio_helped] = counts;
  v("compared", compared);
  v("penalized", penalized);
  v("rejected_by_xi", rejected_by_xi);
  v("ratio_helped", ratio_helped);
}
template <>
inline constexpr bool kAsList<MatcherCounts> = true;
using MatchCounts = std::array<MatcherCounts, static_cast<std::size_t>(Matcher::kCount)>;

/// Adds `more` to `counts`, matcher by matcher.
void add(const MatchCounts& more, MatchCounts& counts);
/// The same if either may be unknown: an unknown term adds nothing.
void add(const std::optional<MatchCounts>& more, std::optional<MatchCounts>& counts);

inline MatcherCounts& at(MatchCounts& counts, Matcher matcher) {
  return counts[static_cast<std::size_t>(matcher)];
}
inline const MatcherCounts& at(const MatchCounts& counts, Matcher matcher) {
  return counts[static_cast<std::size_t>(matcher)];
}

}  // namespace mh
