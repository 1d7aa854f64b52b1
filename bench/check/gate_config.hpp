// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/check/gate.hpp"
#include "slam/core/yaml.hpp"

namespace mh {

/// Reads the section `check` of a suite: `tolerances: {MEASURE: NUMBER | {absolute, relative}}`
/// and `scenarios: {ENVIRONMENT: {MEASURE: ...}}`.
/// @param environments  names that `scenarios` may hold
/// @throws InputError naming file, line, field and value.
GateConfig read_gate(YamlReader node, const std::vector<std::string>& environments);

}  // namespace mh
