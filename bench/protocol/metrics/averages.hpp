// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace mh {

/// The median (mean of the two middle values if their number is even); 0 for an empty list.
double median(std::vector<double> values);
/// The median of the known values; absent if there are none.
std::optional<double> median_of_known(std::span<const std::optional<double>> values);
/// The mean value; 0 for an empty list.
double mean(std::span<const double> values);

}  // namespace mh
