// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

/// What the gate keeps of one run. A figure that the run did not determine is absent.
struct RunFigures {
  std::string scenario;
  std::string system;  ///< system, labels and level: "semantic-exact-pepper"
  std::uint64_t seed = 0;
  std::string digest;  ///< of images, poses and trajectory: equal bits, equal digest
  std::map<std::string, std::optional<double>, std::less<>> values = {};  ///< by measure, count
};

}  // namespace mh
