// SPDX-License-Identifier: Apache-2.0
#include "slam/core/imu.hpp"

#include <algorithm>

namespace mh {

std::span<const ImuReading> imu_between(std::span<const ImuReading> readings, Stamp after_ns,
                                        Stamp to_ns) {
  const auto first = std::ranges::upper_bound(readings, after_ns, {}, &ImuReading::stamp_ns);
  const auto last = std::ranges::upper_bound(readings, to_ns, {}, &ImuReading::stamp_ns);
  return first < last ? std::span<const ImuReading>(first, last) : std::span<const ImuReading>();
}

}  // namespace mh
