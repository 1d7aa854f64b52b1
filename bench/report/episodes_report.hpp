// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/protocol/run_result.hpp"

namespace mh {

/// The table of a suite's episodes: for each variant and system, success with Wilson's 95 %
/// interval, time, SPL, collisions, wrong arrivals and the reasons for failures; below the table,
/// the paired differences of compared systems over the same starts. Empty for a suite without
/// episodes.
std::string episodes_table(const Suite& suite, std::span<const RunResult> runs);

/// One system's episodes in one variant, over all environments.
std::vector<EpisodeScore> episodes_of(std::span<const RunResult> runs, const std::string& system,
                                      const std::string& variant);

/// The same as JSON, with the keys `summary` and `comparisons`.
nlohmann::ordered_json episodes_json(const Suite& suite, std::span<const RunResult> runs);

}  // namespace mh
