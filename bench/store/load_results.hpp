// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/protocol/run_result.hpp"
#include "bench/store/store.hpp"
#include "bench/suite/suite.hpp"

namespace mh {

/// A store's results for a suite.
struct BenchResults {
  std::vector<RunResult> runs;       ///< finished ones, in the order of expand(suite)
  std::vector<FailedRun> failed;     ///< failed ones, in the same order
  std::vector<std::string> missing;  ///< names of the others, such as runs of other shards
};

/// Loads the store's results for the runs of a suite.
/// @param keys  of all its runs
BenchResults load_results(const Store& store, const Suite& suite, const PlannedKeys& keys);
/// The same for the suite that was planned last.
BenchResults load_results(const Store& store, const Suite& suite);

}  // namespace mh
