// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace mh {

/// What the gate records of one run. A figure that the run did not determine is absent.
struct RunFigures {
  std::string scenario;
  std::string system;  ///< system, labels and level: "semantic-exact-pepper"
  std::uint64_t seed = 0;
  std::string digest;  ///< of images, poses and trajectory: equal bits, equal digest
  std::map<std::string, std::optional<double>, std::less<>> values = {};  ///< by the metric's name
  bool repeatable = true;  ///< whether its system is repeatable; not stored in a baseline
};

}  // namespace mh
