// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/cli/progress.hpp"
#include "bench/run/run_suite.hpp"

namespace mh::cli {

/// Writes the results of a suite into its folder and prints them.
/// @throws as throw_failures(), after everything was written.
void finish(const std::filesystem::path& out, const Suite& suite, const BenchResults& results,
            bool json);

/// Returns the names of the files that `bench` and `merge` write into a folder. Empty if a results
/// file in the folder shows that they already wrote there.
std::vector<std::string> names_written(const std::filesystem::path& out, const Suite& suite);

/// Displays the progress of a suite.
void show(Progress& progress, const PoolProgress& suite);

/// Throws if any run failed; otherwise does nothing.
/// @param why     the cause of the failures, or where to find it
/// @param advice  what to do about them; left out if all runs failed because of bad input
/// @throws InputError if all runs failed because of bad input, otherwise MachineError. Both name
/// the first run.
void throw_failures(const std::vector<FailedRun>& failed, const std::string& why,
                    const std::string& advice);

}  // namespace mh::cli
