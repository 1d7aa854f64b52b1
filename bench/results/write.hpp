// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "bench/results/run_result.hpp"
#include "bench/world/world.hpp"

namespace mh {

/// Writes what is large about a run into its folder: truth.tum, estimate.tum, map.bt, map.pgm,
/// map.yaml and topdown.png. Each file appears whole or not at all.
void write_run(const std::filesystem::path& folder, const World& world, const RunResult& run);

/// The contact sheet of an environment.
void write_views(const std::filesystem::path& file, const World& world);

/// Writes what a suite's runs gave together: results.json, times.json, table.txt, times.txt.
/// @returns the printed table.
std::string write_results(const std::filesystem::path& folder, const Suite& suite,
                          std::span<const RunResult> runs, std::span<const FailedRun> failed = {},
                          std::span<const std::string> missing = {});

}  // namespace mh
