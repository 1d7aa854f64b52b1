// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "bench/results/run_result.hpp"
#include "bench/world/world.hpp"

namespace mh {

/// Removes results.json of an earlier execution and the files of the runs that it names, so that
/// none is taken for a new one. Nothing else in the folder is touched.
void remove_older_results(const std::filesystem::path& folder);

/// Writes a suite's results into a folder that exists: results.json, times.json, table.txt,
/// views.png (the contact sheet), and one folder per run with truth.tum, estimate.tum, map.bt,
/// map.pgm, map.yaml and topdown.png. Each file appears whole or not at all.
/// @returns the printed table.
std::string write_results(const std::filesystem::path& folder, const Suite& suite,
                          const World& world, const std::vector<RunResult>& runs, double wall_s);

}  // namespace mh
