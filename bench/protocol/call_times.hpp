// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace mh {

/// Wall time (ms) of every call that handled a frame, in call order.
struct CallTimes {
  std::vector<double> track_ms;
  std::vector<double> relocalize_ms;  ///< calls with the queries' own frames
  std::vector<double> blank_ms;       ///< calls with the blank frames shown before them
  double processor_s = 0;  ///< CPU time of all calls except save and restore, in this process
};

/// Median and 95th percentile, ms.
struct TimeSummary {
  double median_ms = 0;
  double p95_ms = 0;
};
TimeSummary summarize(std::vector<double> times_ms);

}  // namespace mh
