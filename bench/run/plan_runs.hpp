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

/// Checks the settings of a suite with episodes; accepts any other suite.
/// @throws InputError if it combines episodes with settings that have no meaning for them.
void check_episodes(const Suite& suite);

/// Every run of a suite, in the order of expand(), with the key of its result and the names of the
/// images and frames that it sees.
/// @param say  receives a line about each recording left out and each program whose file is unknown
/// @throws InputError if two runs have the same name or are equal in all but their names, if an
/// outside program cannot be started, if an input cannot be read, or as check_episodes() does.
std::vector<Job> plan_runs(const Suite& suite, InputReader& inputs,
                           const std::function<void(std::string_view)>& say);

/// Name and key of each job, as Store::plan() takes them.
PlannedKeys keys_by_name(const std::vector<Job>& jobs);

/// Checks each input of the runs, and each only once: recordings and scenes can be read, tours can
/// be driven, goals of episodes can be found. Generated scenes and motions are valid by
/// construction.
/// @throws InputError
void validate_inputs(const std::vector<Job>& jobs, InputReader& inputs,
                     const std::function<void(std::string_view)>& say);

/// File name of the contact sheet of a run's environment.
std::string views_name(const Suite& suite, const Environment& environment);

struct Reuse {
  bool failures = true;  ///< whether a failed run counts as finished
  bool files = true;     ///< whether the run's folder must not hold another run's files
};

/// Whether a run's result is reused instead of recomputed: it is in the store, and the folder of
/// the run's name does not hold the files of another run. No other code decides this.
/// @param out  contains the run folders
bool is_reused(const Store& store, const Job& job, const std::filesystem::path& out,
               const Reuse& reuse = {});

}  // namespace mh
