// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "bench/protocol/metrics/metric.hpp"
#include "bench/protocol/metrics/query_summary.hpp"

namespace mh {

/// Every metric of one run: those of its mapping by name, those of its queries and
/// episodes as "held_out.success", "episodes.success".
std::span<const Metric> all_metrics();

/// Renames a metric of a query set or of episodes to what it is called among a run's metrics, for
/// example "success" to "held_out.success".
Metric under(std::string_view questions, Metric metric);

/// Finds a metric that the gate may judge; nullptr if there is none with that name.
const Metric* find_metric(std::string_view name);

}  // namespace mh
