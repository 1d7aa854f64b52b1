// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "bench/protocol/run_result.hpp"
#include "bench/protocol/world/world.hpp"

namespace mh {

/// Writes the large files of a run into its folder: truth.tum, estimate.tum, map.bt, map.ot,
/// objects.json, map.pgm, map.yaml, topdown_second_tour.png if there is a second tour, and
/// topdown.png, which contains the run's key. For a recording, whose floor is unknown, there is no
/// map image or drawing, and run.key contains the key. Each file appears whole or not at all.
void write_run(const std::filesystem::path& folder, const World& world, const RunResult& run,
               const std::string& key);
/// Removes what write_run() writes and nothing else: files of an earlier run must not remain next
/// to the result of one that fails or is in progress.
void remove_run(const std::filesystem::path& folder);
/// Whether a folder contains files of write_run() from a run other than the one with that key.
bool shows_another_run(const std::filesystem::path& folder, const std::string& key);

/// Writes the contact sheet of a simulated environment, unless there is already one that was made
/// from the same scene, robot, path and code.
void write_views(const std::filesystem::path& file, const World& world, const RunSpec& spec);

/// Writes the combined results of a suite's runs: results.json, times.json, reproduction.json,
/// table.txt, times.txt and the charts.
void write_results(const std::filesystem::path& folder, const Suite& suite,
                   std::span<const RunResult> runs, std::span<const FailedRun> failed = {},
                   std::span<const std::string> missing = {});

}  // namespace mh
