// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/cli/progress.hpp"
#include "bench/run/run.hpp"

namespace mh::cli {

/// Writes the results of a suite into its folder and prints them.
/// @throws as throw_failures(), after everything was written.
void finish(const std::filesystem::path& out, const Suite& suite, const BenchResults& results,
            bool json);

/// The names that `bench` and `merge` give to what they write into a folder; none where a results
/// file shows that they did so before.
std::vector<std::string> names_written(const std::filesystem::path& out, const Suite& suite);

/// Draws how far a suite has come.
void show(Progress& progress, const PoolProgress& suite);

/// Does nothing if there are none.
/// @param why     where, or what, the cause is
/// @param advice  what helps unless all of them met bad input
/// @throws InputError if all of them met bad input, else MachineError, naming the first.
void throw_failures(const std::vector<FailedRun>& failed, const std::string& why,
                    const std::string& advice);

}  // namespace mh::cli
