// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/step_digest.hpp"

#include "bench/provenance/digest.hpp"

namespace mh {
namespace {

template <class T>
std::uint64_t digest_value(const T& value, std::uint64_t seed) {
  return digest_bytes(&value, sizeof value, seed);
}

}  // namespace

std::uint64_t digest_of_matching(const StepReport& report) {
  const int numbers[] = {static_cast<int>(report.status), report.keypoints, report.inliers,
                         report.keyframe_added ? 1 : 0, static_cast<int>(report.relocalization)};
  std::uint64_t d = digest_value(numbers, 0);
  for (const MatcherCounts& counts : report.matches) {
    const std::int64_t c[] = {counts.compared, counts.penalized, counts.rejected_by_xi,
                              counts.ratio_helped};
    d = digest_value(c, d);
  }
  if (report.candidates) {
    const CandidateCounts& c = *report.candidates;
    const int counts[] = {c.keyframes, c.c1, c.c2, c.c3, c.final};
    d = digest_value(c.label_mass, digest_value(counts, d));
  }
  return d;
}

}  // namespace mh
