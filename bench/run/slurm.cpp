// SPDX-License-Identifier: Apache-2.0
#include "bench/run/slurm.hpp"

#include <poll.h>

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/report/write.hpp"
#include "bench/run/merge_parts.hpp"
#include "bench/run/plan_runs.hpp"
#include "bench/run/run_process.hpp"
#include "bench/run/signal_watch.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/outside_program.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr int kPollSlurm_ms = 200;
constexpr int kNotFound = 127;  // exit code of a shell that does not find a program

std::optional<Store> store_in(const fs::path& folder) {
  if (!fs::exists(folder / "results.sqlite")) return std::nullopt;
  return std::optional<Store>(std::in_place, folder / "results.sqlite");
}

/// Shares, counted from 1, that have runs with no result in `out` or in the share's folder.
/// @param failed  whether a failed run counts as finished
std::vector<std::size_t> unfinished(const std::vector<Job>& jobs,
                                    const std::vector<PredictedShare>& shares, const fs::path& out,
                                    bool failed) {
  const std::optional<Store> all = store_in(out);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const fs::path folder = share_folder(out, i + 1);
    const std::optional<Store> part = store_in(folder);
    const auto is_open = [&](const Job& job) {
      const auto holds = [&](const fs::path& in, const std::optional<Store>& store) {
        return store && is_reused(*store, job, in, {.failures = failed});
      };
      return !holds(out, all) && !holds(folder, part);
    };
    if (std::any_of(jobs.begin() + static_cast<std::ptrdiff_t>(shares[i].begin),
                    jobs.begin() + static_cast<std::ptrdiff_t>(shares[i].end), is_open))
      found.push_back(i + 1);
  }
  return found;
}

/// The id in what sbatch --parsable printed, "12" or "12;CLUSTER"; empty if it has not printed yet.
std::string job_id(const fs::path& file) {
  const std::string text = fs::exists(file) ? read_file(file) : "";
  return text.ends_with('\n') ? text.substr(0, text.find_first_of(";\n")) : "";
}

void cancel(const std::string& id, const fs::path& log) {
  RunProcess scancel("/bin/sh", {"-c", "exec scancel \"$0\"", id}, log);
  while (!scancel.poll()) ::poll(nullptr, 0, kPollSlurm_ms);
}

/// Submits the array and waits until every task has ended, successfully or not.
void submit(const fs::path& folder, const std::vector<std::string>& words,
            const std::function<void(std::string_view)>& say) {
  const SignalWatch watch;
  const fs::path id_file = folder / "job", log = folder / "sbatch.log";
  fs::remove(id_file);
  std::vector<std::string> command = {"-c", "exec sbatch \"$@\" >\"$0\"", id_file.string()};
  command.insert(command.end(), words.begin(), words.end());
  RunProcess sbatch("/bin/sh", command, log);
  for (std::string id;;) {
    const std::optional<ProcessEnd> end = sbatch.poll();
    if (id.empty() && !(id = job_id(id_file)).empty())
      say(fmt::format("job {} is submitted; its tasks write {}", id,
                      (folder / "SHARE.log").string()));
    if (watch.signal() != 0) {
      if (!id.empty()) cancel(id, folder / "scancel.log");
      throw Interrupted{watch.signal()};
    }
    if (end && id.empty() && end->code == kNotFound)
      throw MachineError(
          "--slurm: there is no sbatch on PATH: Slurm's commands are missing (Debian: "
          "slurm-client)");
    if (end && id.empty())
      throw MachineError(fmt::format("--slurm: nothing was submitted: {}",
                                     end->message.empty() ? "see " + log.string() : end->message));
    if (end) return;
    ::poll(nullptr, 0, kPollSlurm_ms);
  }
}

/// Removes the files of a run if they do not belong to its result; merging the shares brings the
/// right ones.
void remove_outdated(const Suite& suite, const std::vector<Job>& jobs, const fs::path& out) {
  for (const Job& job : jobs) {
    if (!shows_another_run(out / job.spec.name, job.key)) continue;
    remove_run(out / job.spec.name);
    fs::remove(out / views_name(suite, job.spec.environment));
  }
}

}  // namespace

fs::path share_folder(const fs::path& out, std::size_t share) {
  return out / "slurm" / std::to_string(share);
}

std::string task_script(const fs::path& executable, const fs::path& out,
                        const SlurmOptions& slurm) {
  std::string command = shell_quoted(executable.string());
  for (const std::string& argument : slurm.arguments)
    command.append(" ").append(shell_quoted(argument));
  return fmt::format(
      R"(#!/bin/sh
# A share of a suite's runs: a task of the array that `modelhouse bench --slurm` submits.
share=$SLURM_ARRAY_TASK_ID
cd -- {} || exit 2
exec >>{}"/$share.log" 2>&1 </dev/null
echo "share $share on $(hostname), job $SLURM_JOB_ID, restart ${{SLURM_RESTART_COUNT:-0}}"
{} --shard "$share/{}" --out {}"/$share"
code=$?
[ "${{SLURM_RESTART_COUNT:-0}}" -lt 3 ] || exit 0 # clusters may requeue whatever ends badly: no more
# Killed from outside: it goes on from its finished runs, where Slurm finds a place for it.
if [ "$code" -gt 128 ]; then
  echo "share $share: ended with code $code, is requeued"
  scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$share"
fi
exit "$code"
)",
      shell_quoted(fs::current_path().string()), shell_quoted((out / "slurm").string()), command,
      slurm.shares, shell_quoted((out / "slurm").string()));
}

SlurmResults run_on_slurm(const Suite& suite, const SuiteOverrides& overrides,
                          const BenchOptions& options, const SlurmOptions& slurm) {
  InputReader inputs(options.say);
  const std::vector<Job> jobs = plan_runs(suite, inputs, options.say);
  const std::vector<PredictedShare> shares = split_runs(expand(suite), slurm.shares);
  const PlannedKeys plan = keys_by_name(jobs);
  std::vector<std::size_t> waiting = unfinished(jobs, shares, options.out, !options.retry_failed);
  std::vector<Job> to_check;
  std::vector<std::string> costs;
  for (const std::size_t share : waiting)
    for (std::size_t i = shares[share - 1].begin; i < shares[share - 1].end; ++i)
      to_check.push_back(jobs[i]);
  for (const PredictedShare& share : shares)
    costs.push_back(fmt::format("{:.0f}", share.predicted_s));
  validate_inputs(to_check, inputs, options.say);  // bad input must not leave a file behind
  inputs.forget_scene();
  options.say(fmt::format("{} in {} of {} s of processor time as predicted, {} unfinished",
                          counted(jobs.size(), "run"), counted(shares.size(), "share"),
                          fmt::join(costs, ", "), waiting.size()));
  const fs::path out = fs::absolute(options.out).lexically_normal(), folder = out / "slurm";
  if (!waiting.empty()) {
    make_output_folder(folder);
    const fs::path script = folder / "task.sh";
    write_atomically(script, task_script(fs::canonical(options.executable), out, slurm));
    std::vector<std::string> words = {"--parsable",
                                      "--wait",
                                      "--requeue",
                                      fmt::format("--job-name=modelhouse-{}", suite.name),
                                      fmt::format("--cpus-per-task={}", options.jobs),
                                      "--output=/dev/null"};
    words.insert(words.end(), slurm.sbatch.begin(), slurm.sbatch.end());
    words.push_back(fmt::format("--array={}", fmt::join(waiting, ",")));
    words.push_back(script.string());
    submit(folder, words, options.say);
  }

  // A share that was not submitted may have been planned for an earlier version of the suite, so
  // each share is planned again.
  std::vector<fs::path> parts;
  for (std::size_t share = 1; share <= shares.size(); ++share)
    if (const fs::path part = share_folder(out, share); fs::exists(part / "results.sqlite")) {
      Store(part / "results.sqlite").plan(suite, overrides, plan);
      parts.push_back(part);
    }
  Store store(out / "results.sqlite");
  store.plan(suite, overrides, plan);
  if (options.retry_failed)
    for (const Job& job : jobs) store.forget_failure(job.key);
  mergeable_results(out, parts);
  remove_outdated(suite, jobs, out);
  merge_parts(out, parts, [](std::string_view) {});
  return {load_results(store, suite, plan), unfinished(jobs, shares, out, true)};
}

}  // namespace mh
