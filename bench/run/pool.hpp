// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/run/signal_watch.hpp"
#include "bench/store/store.hpp"
#include "bench/suite/run_spec.hpp"

namespace mh {

/// A run and the key of its result.
struct Job {
  RunSpec spec;
  std::string key;
  std::string images = {};  ///< name of the images that it sees; equal for equal images
  std::string frames = {};  ///< likewise for the frames that it maps, noise included
};

/// Prefix of the error of a run that failed on bad input, which the user can fix.
inline constexpr std::string_view kBadInputMark = "bad input: ";

/// Progress of the work.
struct PoolProgress {
  double share = 0;  ///< of all runs done, in [0, 1]
  std::size_t done = 0, failed = 0;
  std::optional<double> to_go_s;  ///< nullopt while there is nothing to estimate it from
  std::string status;  ///< status of a run in progress: "plain-pepper-0: frame 120 of 4490, lost"
};

struct PoolOptions {
  int jobs = 1;  ///< parallel processes; never changes a result
  /// Limit on the wall time of one run, to which the simulated time that its episodes may take is
  /// added; 0 = no limit.
  double time_limit_s = 14400;
  double memory_limit_mb = 0;  ///< limit on the resident set size of one run; 0 = no limit
  std::filesystem::path executable;
  /// Existing folder for each run's log (KEY.log) and for the file that `arguments` writes
  /// (KEY.json). Both files are removed after a success.
  std::filesystem::path work_folder;
  /// The command line of a run's process. The process finishes by putting the result into the
  /// store.
  std::function<std::vector<std::string>(const Job&)> arguments;
  /// Called when no run will need the data of this name anymore (Job::frames, then Job::images).
  std::function<void(const std::string& name)> forget = [](const std::string&) {};
  std::function<void(std::string_view)> say = [](std::string_view) {};
  std::function<void(const PoolProgress&)> progress = [](const PoolProgress&) {};
};

/// Executes the runs that are not in the store yet, each in its own process, and returns when all
/// are in the store, done or failed. Runs that another process has claimed are left to it and
/// waited for.
///
/// - Runs that see the same images (Job::images) follow one another, so that one of them makes the
///   images and the others find them: a free process takes a run whose images exist and are not in
///   use, else the next one in the order of `jobs`.
/// - Another process starts only if there is enough memory for it and for what the running ones
///   still need (as measured on finished ones); at least one always runs.
/// - A run that ends by itself without success is a failure and is not tried again. One that was
///   killed from outside (SIGKILL, SIGTERM, SIGHUP: by a kernel short of memory or by a scheduler)
///   is tried once more, alone. A run that hits a full disk ends all work and is not a failure: the
///   same command resumes once there is space.
/// @throws Interrupted on Ctrl-C, SIGTERM or SIGHUP; DiskFullError.
void run_pending(Store& store, std::vector<Job> jobs, const PoolOptions& options);

}  // namespace mh
