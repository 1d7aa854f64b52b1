// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "bench/protocol/metrics/query_summary.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/core/random.hpp"

namespace mh {

// Every random stream of a run.

/// Fork names of a run's streams: what the draws are for.
struct RunDraw {
  enum Name : std::uint64_t { kNoise = 1, kSlam = 2, kBlank = 3 };
};

/// The stream that mapping draws from (bench/protocol/mapping.hpp).
RandomStream mapping_stream(const RunSpec& spec);

/// The noise of the mapping frames after `restart` restarts; the same for every system.
/// @param stream  mapping_stream()
RandomStream mapping_noise(RandomStream stream, int restart);

/// The noise streams of the mapping frames that the runs of one trial share: the initial stream and
/// one for each of the first restarts. After more restarts, runs hardly share any frames.
std::vector<RandomStream> shared_noises(const RunSpec& spec);

/// The stream that the queries of a set draw from (bench/protocol/query.hpp).
RandomStream query_stream(const RunSpec& spec, QuerySet set);

}  // namespace mh
