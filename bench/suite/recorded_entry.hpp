// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/suite/environment.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// Reads an entry `sequence` of a suite's environments (read_environments()).
std::vector<Environment> read_recorded_entry(YamlReader node, const SuitePaths& paths);

/// Reads an entry `sequences`: one environment for each recording that matches. Adds what it found
/// and what it left out to `all`.
std::vector<Environment> read_pattern_entry(YamlReader node, const SuitePaths& paths,
                                            Environments& all);

/// The path of a recording in canonical form: without a trailing slash and, if `paths.must_exist`,
/// with links resolved.
std::string place_of(const std::string& sequence, const SuitePaths& paths);

}  // namespace mh
