// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/averages.hpp"

#include <algorithm>
#include <numeric>

namespace mh {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::optional<double> median_of_known(std::span<const std::optional<double>> values) {
  std::vector<double> known;
  for (const std::optional<double>& value : values)
    if (value) known.push_back(*value);
  return known.empty() ? std::nullopt : std::optional(median(std::move(known)));
}

double mean(std::span<const double> values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace mh
