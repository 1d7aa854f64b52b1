// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "bench/plan/suite.hpp"
#include "bench/results/run_result.hpp"
#include "bench/run_one.hpp"
#include "bench/world/world.hpp"

namespace mh {

struct RunOptions {
  int jobs = 1;                       ///< runs at work at a time; never changes a result
  Say say = [](std::string_view) {};  ///< told the stages of the work
  std::function<void(double)> progress = [](double) {};  ///< share of all work done, in [0, 1]
  /// Told each result with its world as it comes, never two at once: what is large is written here.
  std::function<void(const World&, RunResult&)> finished = [](const World&, RunResult&) {};
};

/// All runs of a suite, in the order of expand(suite). Environments follow one another.
std::vector<RunResult> run_all(const Suite& suite, const RunOptions& options);

}  // namespace mh
