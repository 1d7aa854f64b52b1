// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "bench/protocol/metrics/metric.hpp"
#include "bench/results/rows.hpp"
#include "slam/core/match_counts.hpp"

namespace mh {

inline constexpr const char* kResultsFormat = "modelhouse-results-4";

/// All of a suite's results that are a function of suite, binary and seeds: the resolved settings,
/// digests, one entry per run with its queries and episodes, the rows of the table, the
/// comparisons.
nlohmann::ordered_json results_json(const Suite& suite, std::span<const RunResult> runs,
                                    std::span<const FailedRun> failed = {},
                                    std::span<const std::string> missing = {});

/// Everything that a run produced, except its times.
nlohmann::ordered_json run_json(const RunResult& run);
nlohmann::ordered_json run_json(const FailedRun& run);

/// The figures of a score by their names; a name with dots becomes nested objects.
nlohmann::ordered_json figures_json(std::span<const Figure> figures);

/// Counts by matcher; null if unknown.
nlohmann::ordered_json matches_json(const std::optional<MatchCounts>& matches);

/// Everything needed to reproduce the results: the command, which works from any folder, the commit
/// and digest of the code, build and machine, the resolved suite, seeds and digests of the inputs.
nlohmann::ordered_json reproduction_json(const Suite& suite, std::span<const RunResult> runs);

/// What differs from one execution to the next: wall time, time per frame.
nlohmann::ordered_json times_json(std::span<const RunResult> runs);

}  // namespace mh
