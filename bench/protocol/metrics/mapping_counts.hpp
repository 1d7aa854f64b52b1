// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/protocol/metrics/metric.hpp"

namespace mh {

/// Counts of a mapping, in addition to its trajectory.
struct MappingCounts {
  double failures = 0;  ///< how often tracking was lost
  double restarts = 0;  ///< rewinds
  double dropped = 0;   ///< frames dropped for good
  /// Share of pairs whose labels disagree, among all pairs compared with the local map. Shows how
  /// much labels contribute. Absent if the system does not report it.
  std::optional<double> penalized;
};

template <MaybeConst<MappingCounts> C, class Visit>
void fields(C& counts, Visit& v) {
  using enum Better;
  auto& [failures, restarts, dropped, penalized] = counts;
  v(Metric{"failures", "", "", 0, kLess}, failures);
  v(Metric{"restarts", "restarts", "", 0, kLess}, restarts);
  v(Metric{"dropped", "dropped", "", 0, kLess}, dropped);
  v(Metric{"penalized", "", "%", 2, kLess}, penalized);
}

}  // namespace mh
