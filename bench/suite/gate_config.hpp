// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "slam/io/yaml.hpp"

namespace mh {

/// How much worse a measure may get: by the greater of the two limits. If both are 0, it may not
/// get worse at all.
struct Tolerance {
  double absolute = 0;  ///< in the measure's unit
  double relative = 0;  ///< as a share of the baseline's median
  double of(double baseline_median) const;
};

/// By measure; a measure without a tolerance is neither reported nor judged.
using Tolerances = std::map<std::string, Tolerance, std::less<>>;

struct GateConfig {
  Tolerances tolerances;
  std::map<std::string, Tolerances, std::less<>>
      of_scenario;  ///< by environment, overriding `tolerances`
};

/// Reads the section `check` of a suite: `tolerances: {MEASURE: NUMBER | {absolute, relative}}`
/// and `scenarios: {ENVIRONMENT: {MEASURE: ...}}`.
/// @param environments  names that `scenarios` may contain
/// @throws InputError naming file, line, field and value.
GateConfig read_gate(YamlReader node, const std::vector<std::string>& environments);

}  // namespace mh
