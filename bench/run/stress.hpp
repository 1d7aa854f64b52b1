// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/results/stress_results.hpp"
#include "bench/run/run_suite.hpp"
#include "bench/suite/suite.hpp"

namespace mh {

struct StressOptions {
  BenchOptions bench;   ///< the runs are kept in its folder: what is done is not repeated
  double budget_s = 0;  ///< no further dial is begun after this time; 0: no limit
  /// Called before each step: share of the dials that are done, and what is run.
  std::function<void(double share, std::string_view what)> step = [](double, std::string_view) {};
};

/// What systems do at a dose, in their order; `is_fault` false: without the fault.
using RunAtDose = std::function<std::vector<StressedAt>(
    const std::vector<std::size_t>& systems, const StressDial& dial, double dose, bool is_fault)>;

/// Finds the breaking point of each system at each dial by bisection.
StressResults find_breaking_points(const Suite& suite, const RunAtDose& run,
                                   const StressOptions& options);

/// The same with runs of the suite: each step asks the same questions about the same frames.
/// @throws InputError if the suite has no section `stress`, or more than one level or kind of
/// labels
StressResults stress(const Suite& suite, const SuiteOverrides& overrides,
                     const StressOptions& options);

}  // namespace mh
