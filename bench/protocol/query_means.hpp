// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bench/protocol/metrics/episode_summary.hpp"
#include "bench/protocol/metrics/mapping_counts.hpp"
#include "bench/protocol/run_result.hpp"

// The figures of one run. The store keeps them, so this code is part of a run's key.

namespace mh {

QuerySummary summarize(std::span<const QueryScore> queries);
EpisodeSummary summarize(std::span<const EpisodeScore> episodes);

MappingCounts count(const MappingOutcome& mapping);

/// Every figure of a run under one of its parameter points, under its name in all_metrics(). Leaves
/// out query sets that were not used, and episodes if the run has none.
std::vector<Figure> figures_of(const RunResult& run, std::size_t point);

}  // namespace mh
