// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/metrics/metric.hpp"

namespace mh {

/// What a mapping took, beside its trajectory.
struct MappingCounts {
  double failures = 0;  ///< times that tracking was lost
  double restarts = 0;  ///< rewinds
  double dropped = 0;   ///< frames given up
  /// Share of the pairs compared with the local map whose labels disagree: what labels are worth.
  /// Absent where the system tells of none.
  std::optional<double> penalized;
};

template <Either<MappingCounts> C, class Visit>
void fields(C& counts, Visit& v) {
  using enum Better;
  auto& [failures, restarts, dropped, penalized] = counts;
  v(Metric{"failures", "", "", 0, kLess}, failures);
  v(Metric{"restarts", "restarts", "", 0, kLess}, restarts);
  v(Metric{"dropped", "dropped", "", 0, kLess}, dropped);
  v(Metric{"penalized", "", "%", 2, kLess}, penalized);
}

}  // namespace mh
