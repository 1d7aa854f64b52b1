// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/call_times.hpp"

#include <algorithm>
#include <cstddef>

namespace mh {

TimeSummary summarize(std::vector<double> times_ms) {
  if (times_ms.empty()) return {};
  std::sort(times_ms.begin(), times_ms.end());
  const auto at = [&](double share) {
    return times_ms[static_cast<std::size_t>(share * static_cast<double>(times_ms.size() - 1))];
  };
  return {at(0.5), at(0.95)};
}

}  // namespace mh
