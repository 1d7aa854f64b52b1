// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/loop_audit.hpp"

#include <algorithm>
#include <numbers>

#include "bench/protocol/score.hpp"

namespace mh {

LoopAudit audit_loops(std::span<const LoopClosure> loops, const Trajectory& truth,
                      const ProtocolConfig& config) {
  const double most_rad = config.correct_angle_deg * std::numbers::pi / 180.0;
  LoopAudit audit;
  for (const LoopClosure& loop : loops) {
    ++audit.closed;
    const auto old_pose = interpolated_pose(truth, loop.old_stamp_ns, kMaxTruthGap_ns);
    const auto new_pose = interpolated_pose(truth, loop.stamp_ns, kMaxTruthGap_ns);
    if (!old_pose || !new_pose) {
      ++audit.unknown;
      continue;
    }
    const SE3 exact = old_pose->inverse() * *new_pose;
    const double distance_m = (loop.old_from_new.translation() - exact.translation()).norm();
    const double angle_rad = angle_between_rad(loop.old_from_new, exact);
    audit.worst_m = std::max(audit.worst_m, distance_m);
    audit.worst_rad = std::max(audit.worst_rad, angle_rad);
    audit.false_positive += distance_m > config.correct_distance_m || angle_rad > most_rad ? 1 : 0;
  }
  return audit;
}

}  // namespace mh
