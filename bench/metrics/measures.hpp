// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "bench/metrics/metric.hpp"
#include "bench/metrics/query_summary.hpp"

namespace mh {

/// Every figure of one run: of its mapping by name, of its queries as "held_out.success".
std::span<const Metric> all_metrics();

/// The metric of a set's queries under its name among those of a run.
Metric of_set(QuerySet set, Metric metric);

/// A metric that the gate may judge. nullptr if there is none of that name.
const Metric* find_measure(std::string_view name);

}  // namespace mh
