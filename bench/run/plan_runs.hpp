// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/run/pool.hpp"
#include "bench/store/store.hpp"
#include "bench/suite/inputs.hpp"

namespace mh {

/// Checks what a suite with episodes asks for; passes others.
/// @throws InputError if it combines them with what has no meaning there.
void check_episodes(const Suite& suite);

/// Every run of a suite, in the order of expand(), with the key of its result and what it sees.
/// @param say  receives which recordings are left out and which programs cannot be seen
/// @throws InputError if two runs have one name or are equal in all but their names, if an input
/// cannot be read; as check_episodes().
std::vector<Job> plan_runs(const Suite& suite, InputReader& inputs,
                           const std::function<void(std::string_view)>& say);

/// As Store::plan() takes them: name, key.
PlannedKeys keys_by_name(const std::vector<Job>& jobs);

/// Checks all inputs that the runs name, each once: outside programs can be started, scenes read,
/// tours driven, goals of episodes found. Generated scenes and motions are valid by construction.
/// @throws InputError
void validate_inputs(const std::vector<Job>& jobs, InputReader& inputs,
                     const std::function<void(std::string_view)>& say);

/// File name of the contact sheet of a run's environment.
std::string views_name(const Suite& suite, const Environment& environment);

struct Reuse {
  bool failures = true;  ///< a failed run counts as finished
  bool files = true;     ///< the files of runs count, too
};

/// Whether the result of a run is reused instead of making it again: it is in the store, and the
/// folder of its name holds the files of no other run. The one place where this is decided.
/// @param out  holds the folders of runs
bool is_reused(const Store& store, const Job& job, const std::filesystem::path& out,
               const Reuse& reuse = {});

}  // namespace mh
