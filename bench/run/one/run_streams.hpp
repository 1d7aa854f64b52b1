// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/protocol/metrics/query_summary.hpp"
#include "bench/suite/runs.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// The stream that mapping draws from (bench/protocol/mapping.hpp).
RandomStream mapping_stream(const RunSpec& spec);

/// The noises that the mapping frames of a trial's runs have in common: at first, and after each of
/// its first restarts. With more restarts, runs hardly have frames in common.
std::vector<RandomStream> shared_noises(const RunSpec& spec);

/// The stream that the queries of a set draw from (bench/protocol/query.hpp).
RandomStream query_stream(const RunSpec& spec, QuerySet set);

}  // namespace mh
