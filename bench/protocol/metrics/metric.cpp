// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/metric.hpp"

#include <fmt/format.h>

namespace mh {

std::string shown(const Figure& figure) {
  if (!figure.value) return "-";
  const bool is_share = figure.metric.unit == "%";
  return fmt::format("{:.{}f}{}", (is_share ? 100 : 1) * *figure.value, figure.metric.decimals,
                     is_share ? "%" : "");
}

}  // namespace mh
