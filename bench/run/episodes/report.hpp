// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/run/episodes/run_episodes.hpp"

namespace mh {

/// The table of a suite's episodes: for each variant and system success with Wilson's 95 %
/// interval, time, SPL, collisions, wrong arrivals and the reasons of failures; below, the paired
/// differences of compared systems over the same starts.
std::string episodes_table(const Suite& suite, const std::vector<EpisodeRun>& runs);

/// All of it, and every episode.
nlohmann::ordered_json episodes_json(const Suite& suite, const std::vector<EpisodeRun>& runs);

/// Writes table.txt and episodes.json. @returns the table
std::string write_episodes(const std::filesystem::path& out, const Suite& suite,
                           const std::vector<EpisodeRun>& runs);

/// The files that write_episodes() and run_episodes() leave, for the check of the output folder.
inline constexpr const char* kEpisodeFiles[] = {"table.txt", "episodes.json", "episodes.sqlite"};

}  // namespace mh
