// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace mh {

enum class Better { kLess, kMore };

/// A measure that the gate may judge.
struct Measure {
  std::string_view name;
  Better better = Better::kLess;
  std::string_view unit;   ///< "", "m"
  std::string_view count;  ///< shares: the figure that holds their denominator; else empty
};

/// Every measure, in the order of the report.
std::span<const Measure> measures();
/// nullptr if there is none of that name.
const Measure* find_measure(std::string_view name);

}  // namespace mh
