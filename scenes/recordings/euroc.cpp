// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/euroc.hpp"

#include <fmt/format.h>

namespace mh {

std::string euroc_line(const ImuReading& reading) {
  const auto& w = reading.turn_rad_per_s;
  const auto& a = reading.specific_force_m_per_s2;
  return fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", reading.stamp_ns, w.x(),
                     w.y(), w.z(), a.x(), a.y(), a.z());
}

}  // namespace mh
