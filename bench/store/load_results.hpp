// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/plan/suite.hpp"
#include "bench/results/run_result.hpp"
#include "bench/store/store.hpp"

namespace mh {

/// What a store holds of a suite.
struct BenchResults {
  std::vector<RunResult> runs;       ///< finished ones, in the order of expand(suite)
  std::vector<FailedRun> failed;     ///< likewise
  std::vector<std::string> missing;  ///< names of those that are neither: of other shards
};

/// What the store holds of the suite that was planned last.
BenchResults load_results(const Store& store, const Suite& suite);

}  // namespace mh
