// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "bench/run/pool.hpp"
#include "bench/suite/inputs.hpp"

namespace mh {

/// Every run of a suite, in the order of expand(), with the key of its result and what it sees.
/// @param say  receives which recordings are left out and which programs cannot be seen
/// @throws InputError if two runs have one name or are equal in all but their names, or if an input
/// cannot be read.
std::vector<Job> plan_runs(const Suite& suite, InputReader& inputs,
                           const std::function<void(std::string_view)>& say);

/// As Store::plan() takes them: name, key.
PlannedKeys keys_by_name(const std::vector<Job>& jobs);

/// Checks all inputs that the runs name, each once: outside programs can be started, scenes read,
/// tours driven. Generated scenes and motions are valid by construction.
/// @throws InputError
void validate_inputs(const std::vector<Job>& jobs, InputReader& inputs,
                     const std::function<void(std::string_view)>& say);

/// File name of the contact sheet of a run's environment.
std::string views_name(const Suite& suite, const RunSpec& spec);

}  // namespace mh
