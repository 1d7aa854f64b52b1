// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "bench/run/run_suite.hpp"

namespace mh {

/// Where two executions of one suite first differ.
struct Difference {
  std::string run;    ///< empty if the results as a whole differ
  std::string phase;  ///< "world", "mapping", "held_out", "second_tour", "episodes" or "result"
  std::size_t frame = 0;
  int restart = 0;    ///< number of restarts of the mapping before the frame was shown
  std::string stage;  ///< "scene", "path", "order", "image", "matching", "pose", "map", "scores";
                      ///< for episodes, which episode
  friend bool operator==(const Difference&, const Difference&) = default;
};

/// One line: "semantic-exact-pepper-0: mapping: frame 37: image differs".
std::string describe(const Difference& difference);

/// Compares stage by stage in the order of execution; nullopt if every bit agrees.
std::optional<Difference> first_difference(const RunResult& a, const RunResult& b);
std::optional<Difference> first_difference(std::span<const RunResult> a,
                                           std::span<const RunResult> b);

/// Digests of one execution, to be printed side by side.
struct ExecutionDigests {
  std::uint64_t scene = 0, path = 0, images = 0, matching = 0, poses = 0, maps = 0, results = 0;
  friend bool operator==(const ExecutionDigests&, const ExecutionDigests&) = default;
};
ExecutionDigests digests(const Suite& suite, std::span<const RunResult> runs);

struct Verification {
  ExecutionDigests first, second;  ///< with 1 job and with 4
  std::optional<Difference> difference;
};

/// Executes a suite twice from its files, once with 1 job and once with 4, sharing nothing between
/// the two (no store, no cache), and compares the results.
/// @throws MachineError if a run failed.
Verification verify(const Suite& suite, const SuiteOverrides& overrides, BenchOptions options);

}  // namespace mh
