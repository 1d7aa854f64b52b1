// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/run/run_suite.hpp"

namespace mh {

/// How a suite is spread over the machines of a cluster.
struct SlurmOptions {
  std::size_t shares = 1;           ///< tasks of the array
  std::vector<std::string> sbatch;  ///< more arguments for sbatch: partition, account, memory
  /// This program's arguments for one share: `bench SUITE ...`, without --shard and --out.
  std::vector<std::string> arguments;
};

struct SlurmResults {
  BenchResults results;
  std::vector<std::size_t> incomplete;  ///< shares with missing runs, counted from 1
};

/// Folder of a share's results, inside the suite's.
std::filesystem::path share_folder(const std::filesystem::path& out, std::size_t share);

/// Batch script of the job array; a task's number is that of its share, from 1. A task runs its
/// share and, if the program was killed, requeues itself, at most three times. The log is next to
/// the share's folder.
/// @param executable, out  paths as seen from the cluster's nodes
std::string task_script(const std::filesystem::path& executable, const std::filesystem::path& out,
                        const SlurmOptions& slurm);

/// Like run_suite(), but as a Slurm job array: each task does a share of the runs (split_runs) in a
/// folder of its own; finally, all results are merged into options.out. Only shares with unfinished
/// runs are submitted, so the same call resumes.
/// @throws InputError if an input cannot be read; MachineError if Slurm's commands are missing or
/// nothing could be submitted; Interrupted on Ctrl-C, after canceling the array.
SlurmResults run_on_slurm(const Suite& suite, const SuiteOverrides& overrides,
                          const BenchOptions& options, const SlurmOptions& slurm);

}  // namespace mh
