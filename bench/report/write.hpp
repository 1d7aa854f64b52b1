// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "bench/results/run_result.hpp"
#include "bench/world/world.hpp"

namespace mh {

/// Writes what is large about a run into its folder: truth.tum, estimate.tum, map.bt, map.pgm,
/// map.yaml and topdown.png, which holds the run's key. Of a recording, whose floor nobody knows,
/// there is no map.pgm and no picture, and run.key holds the key. Each file appears whole or not at
/// all.
void write_run(const std::filesystem::path& folder, const World& world, const RunResult& run,
               const std::string& key);
/// Removes what write_run() writes, nothing else: another run's files must not stand beside the
/// result of one that fails, or that is under way.
void remove_run(const std::filesystem::path& folder);
/// Whether a folder holds files of write_run(), and not those of the run of that key.
bool shows_another_run(const std::filesystem::path& folder, const std::string& key);

/// The contact sheet of a simulated environment, unless the one that is there was made of the same
/// scene, robot, way and code.
void write_views(const std::filesystem::path& file, const World& world, const RunSpec& spec);

/// Writes what a suite's runs gave together: results.json, times.json, table.txt, times.txt.
/// @returns the printed table.
std::string write_results(const std::filesystem::path& folder, const Suite& suite,
                          std::span<const RunResult> runs, std::span<const FailedRun> failed = {},
                          std::span<const std::string> missing = {});

}  // namespace mh
