// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "bench/plan/suite.hpp"
#include "bench/results/run_result.hpp"
#include "bench/run_one.hpp"
#include "bench/world/world.hpp"

namespace mh {

struct RunOptions {
  int jobs = 1;                                ///< runs at work at a time; never changes a result
  std::optional<std::size_t> max_frames = {};  ///< cuts the tours: for a quick look
  Say say = [](std::string_view) {};           ///< told the stages of the work
  /// Told how much of all runs is done, in [0, 1]; called from several threads, never at once.
  std::function<void(double)> progress = [](double) {};
  RunTamper tamper = {};  ///< for the tests of `verify` only
};

/// Makes the system of a run.
using SystemFactory =
    std::function<std::unique_ptr<System>(const RunSpec&, const Suite&, const World&)>;

/// Our own SLAM with the suite's settings, or its neutral ones for the plain system.
std::unique_ptr<System> make_system(const RunSpec& spec, const Suite& suite, const World& world);

/// All runs of a suite over one world, in the order of expand(suite). Runs that share sensor noise
/// (one level, one trial) go side by side in lockstep, so that each picture is rendered once.
std::vector<RunResult> run_all(const Suite& suite, const World& world, const RunOptions& options,
                               const SystemFactory& factory = make_system);

}  // namespace mh
