// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <time.h>

#include <algorithm>
#include <vector>

namespace mh {

/// The current time of a system clock, ms: CLOCK_THREAD_CPUTIME_ID, CLOCK_MONOTONIC, ...
inline double clock_ms(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// CPU time of this thread, ms.
inline double thread_ms() {
  return clock_ms(CLOCK_THREAD_CPUTIME_ID);
}

/// The median; for an even number of values, the upper one of the two in the middle. @pre not empty
inline double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace mh
