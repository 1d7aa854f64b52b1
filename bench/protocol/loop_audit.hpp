// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "bench/suite/protocol_config.hpp"
#include "slam/core/loop_closure.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// Correctness of the loops that a system closed.
struct LoopAudit {
  int closed = 0;
  int false_positive = 0;  ///< farther from the truth than a correct answer may be
  int unknown = 0;         ///< not judged: the true pose at one end is unknown
  double worst_m = 0;      ///< largest error of a loop's relative position
  double worst_rad = 0;    ///< largest error of its relative rotation
  friend bool operator==(const LoopAudit&, const LoopAudit&) = default;
};

/// Compares each loop's relative pose with the true one. A loop is a false positive if it is off by
/// more than config.correct_distance_m or config.correct_angle_deg, like an answer to a query.
/// @param truth  ordered by stamp; interpolated at a loop's stamps in the same way as at a query's
///               stamp (kMaxTruthGap_ns)
LoopAudit audit_loops(std::span<const LoopClosure> loops, const Trajectory& truth,
                      const ProtocolConfig& config);

}  // namespace mh
