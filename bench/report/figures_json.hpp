// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/protocol/metrics/metric.hpp"
#include "slam/core/match_counts.hpp"

namespace mh {

/// The figures of a score by their names; dots in a name are objects within objects.
nlohmann::ordered_json figures_json(std::span<const Figure> figures);

/// Counts by matcher; null if unknown.
nlohmann::ordered_json matches_json(const std::optional<MatchCounts>& matches);

}  // namespace mh
