// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/protocol/run_result.hpp"
#include "bench/run/pool.hpp"
#include "bench/run/shard.hpp"
#include "bench/store/store.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/suite.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {

struct BenchOptions {
  std::filesystem::path out;  ///< exists; holds results.sqlite and a folder per run
  int jobs = 1;               ///< never changes a result
  Shard shard;
  /// Folder of the cache; nullopt: light is baked once, for this command alone, and each run redoes
  /// its mapping.
  std::optional<std::filesystem::path> cache;
  double time_limit_s = 14400;  ///< as in PoolOptions
  double memory_limit_mb = 0;   ///< limit for one run; 0 = no limit
  /// Disk space, in options.out, for images that runs share; 0: each renders its own. Never changes
  /// a result.
  double images_limit_gb = 20;
  bool retry_failed = false;
  int live_port = 0;  ///< as in RunOrder; only with one job
  /// Metrics only: no occupancy map, no images and no files of runs.
  bool metrics_only = false;
  std::filesystem::path executable = "/proc/self/exe";  ///< has the subcommand `run-child`
  FolderHold* hold = nullptr;  ///< the caller's, on `out`; null: `out` is held only during the runs
  InputReader* inputs = nullptr;  ///< has already read some inputs; null: a new one is used
  std::function<void(std::string_view)> say = [](std::string_view) {};
  std::function<void(const PoolProgress&)> progress = [](const PoolProgress&) {};
};

/// Runs a suite into options.out / "results.sqlite". A finished run is never repeated. Several
/// processes may run the same suite at the same time: they share the runs.
/// @throws InputError if an input cannot be read or changes meanwhile, or if another suite is
/// running in that folder; Interrupted on Ctrl-C.
BenchResults run_suite(const Suite& suite, const SuiteOverrides& overrides,
                       const BenchOptions& options);

}  // namespace mh
