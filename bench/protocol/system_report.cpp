// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/system_report.hpp"

#include "slam/core/digest.hpp"

namespace mh {
namespace {

constexpr int kNotReported = -1;  ///< not a valid count

template <class T>
std::uint64_t digest_value(const T& value, std::uint64_t seed) {
  return digest_bytes(&value, sizeof value, seed);
}

}  // namespace

std::uint64_t digest_of_matching(const SystemReport& report) {
  const int numbers[] = {
      static_cast<int>(report.status), report.keypoints.value_or(kNotReported),
      report.inliers.value_or(kNotReported), report.keyframe_added ? 1 : 0,
      report.relocalization ? static_cast<int>(*report.relocalization) : kNotReported};
  std::uint64_t d = digest_value(numbers, 0);
  for (const MatcherCounts& counts : report.matches.value_or(MatchCounts{})) {
    const std::int64_t c[] = {counts.compared, counts.penalized, counts.rejected_by_xi,
                              counts.ratio_helped};
    d = digest_value(c, d);
  }
  if (report.candidates != Candidates{}) {
    const Candidates& c = report.candidates;
    const int counts[] = {c.keyframes.value_or(kNotReported), c.c1.value_or(kNotReported),
                          c.c2.value_or(kNotReported), c.c3.value_or(kNotReported),
                          c.final.value_or(kNotReported)};
    d = digest_value(c.label_mass.value_or(kNotReported), digest_value(counts, d));
  }
  return d;
}

}  // namespace mh
