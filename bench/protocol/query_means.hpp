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

/// Every figure of a run at one of its parameter points, with its name in all_metrics(). Figures of
/// query sets that were not used, and of episodes if the run has none, are left out.
std::vector<Figure> figures_of(const RunResult& run, std::size_t point);

}  // namespace mh
