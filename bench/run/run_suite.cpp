// SPDX-License-Identifier: Apache-2.0
#include "bench/run/run_suite.hpp"

#include <unistd.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "bench/report/write.hpp"
#include "bench/run/execute_run.hpp"
#include "bench/run/plan_runs.hpp"
#include "bench/suite/cache.hpp"
#include "bench/suite/inputs.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

fs::path real_executable(const fs::path& executable) {
  std::error_code error;
  const fs::path real = fs::canonical(executable, error);
  return error ? executable : real;
}

/// Warns about missing files of finished runs: they will not be written again.
void warn_missing_outputs(const Suite& suite, const BenchResults& results,
                          const BenchOptions& options) {
  std::size_t runs = 0;
  std::set<std::string> views;
  for (const RunResult& run : results.runs) {
    runs += fs::exists(options.out / run.spec.name / "estimate.tum") ? 0 : 1;
    if (run.spec.environment.is_recorded()) continue;  // it has no images
    if (const std::string name = views_name(suite, run.spec.environment);
        !fs::exists(options.out / name))
      views.insert(name);
  }
  if (runs == 0 && views.empty()) return;
  options.say(fmt::format(
      "warning: {} of finished runs and {} of images are missing from {}; their results are kept, "
      "use another --out to rebuild them",
      counted(runs, "folder"), counted(views.size(), "sheet"), options.out.string()));
}

/// If a scene was changed and changed back, the files in a run's folder are from the run in
/// between. The run's stored result is then forgotten, so that the run is repeated; if the run
/// failed, only the files are removed.
void forget_outdated_runs(Store& store, const std::vector<Job>& jobs, const fs::path& out) {
  for (const Job& job : jobs) {
    const fs::path folder = out / job.spec.name;
    const auto status = store.status(job.key);
    if (!status || !shows_another_run(folder, job.key)) continue;
    if (status == RunStatus::kDone)
      store.forget(job.key);
    else
      remove_run(folder);
  }
}

/// Keeps only the jobs in this machine's share.
void take_share(std::vector<Job>& jobs, const BenchOptions& options) {
  if (options.shard.of > 1) {
    std::vector<PredictedCost> costs;
    double all_s = 0;
    for (const Job& job : jobs) costs.push_back(predicted_cost(job.spec));
    const std::vector<PredictedShare> shares = split_runs(costs, options.shard.of);
    const PredictedShare& mine = shares[options.shard.index - 1];
    for (const PredictedShare& share : shares) all_s += share.predicted_s;
    options.say(fmt::format("share {} of {}: {}, {:.0f} of {:.0f} s of processor time as predicted",
                            options.shard.index, options.shard.of,
                            counted(mine.end - mine.begin, "run"), mine.predicted_s, all_s));
    jobs = {jobs.begin() + static_cast<std::ptrdiff_t>(mine.begin),
            jobs.begin() + static_cast<std::ptrdiff_t>(mine.end)};
  }
}

/// Clears the names of shared data in jobs that must not share, or that have no other job to share
/// with.
void limit_sharing(std::vector<Job>& jobs, const BenchOptions& options) {
  std::map<std::string, int> viewers;
  for (const Job& job : jobs) ++viewers[job.frames];
  for (Job& job : jobs) {
    if (options.images_limit_gb <= 0) job.images.clear();
    if (options.images_limit_gb <= 0 || viewers[job.frames] == 1) job.frames.clear();
  }
}

/// Bytes available for the images of each environment in progress.
std::uint64_t limit_of_images(const std::vector<Job>& jobs, const BenchOptions& options) {
  std::set<std::string> all;
  for (const Job& job : jobs) all.insert(job.images);
  const std::size_t at_work = std::min(all.size(), static_cast<std::size_t>(options.jobs));
  return static_cast<std::uint64_t>(1e9 * options.images_limit_gb /
                                    static_cast<double>(std::max<std::size_t>(1, at_work)));
}

}  // namespace

BenchResults run_suite(const Suite& suite, const SuiteOverrides& overrides,
                       const BenchOptions& options) {
  InputReader own_inputs(options.say);
  InputReader& inputs = options.inputs != nullptr ? *options.inputs : own_inputs;
  std::vector<Job> mine = plan_runs(suite, inputs, options.say);
  const PlannedKeys plan = keys_by_name(mine);
  take_share(mine, options);
  const fs::path results = options.out / "results.sqlite";
  std::vector<Job> unfinished = mine;
  if (fs::exists(results)) {
    const Store before(results);
    before.check();
    const Reuse reuse{.failures = !options.retry_failed, .files = !options.metrics_only};
    std::erase_if(unfinished,
                  [&](const Job& job) { return is_reused(before, job, options.out, reuse); });
  }
  validate_inputs(unfinished, inputs, options.say);  // bad input must not leave a file behind
  inputs.forget_scene();

  Store store(results);
  FolderHold own_hold(options.out);
  FolderHold& hold = options.hold != nullptr ? *options.hold : own_hold;
  hold.join([&] { store.plan(suite, overrides, plan); },
            [&] { return store.is_planned(suite, overrides, plan); });
  if (options.retry_failed)
    for (const Job& job : mine) store.forget_failure(job.key);
  if (!options.metrics_only) forget_outdated_runs(store, mine, options.out);
  const Reuse reuse{.files = !options.metrics_only};
  std::erase_if(mine, [&](const Job& job) { return is_reused(store, job, options.out, reuse); });
  limit_sharing(mine, options);
  options.say(fmt::format("{}, {} of them to do", counted(plan.size(), "run"), mine.size()));

  if (!mine.empty()) {
    const TemporaryFolder work(options.out);
    const fs::path cache = options.cache ? *options.cache : work.path() / "cache";
    if (options.cache)
      if (const std::string why = Cache(cache).why_unwritable(); !why.empty())
        options.say(fmt::format(
            "warning: the cache keeps nothing, light and maps are made anew in each run: {}", why));
    const fs::path images = work.path() / "images";
    const std::uint64_t images_limit = limit_of_images(mine, options);
    const std::string session_start = utc_now();
    PoolOptions pool;
    pool.jobs = options.jobs;
    pool.time_limit_s = options.time_limit_s;
    pool.memory_limit_mb = options.memory_limit_mb;
    pool.executable = real_executable(options.executable);
    pool.work_folder = work.path();
    pool.arguments = [&](const Job& job) {
      RunOrder order{.spec = job.spec,
                     .key = job.key,
                     .store = store.file(),
                     .folder = options.out,
                     .cache = cache,
                     .share_noise = !job.frames.empty(),
                     .views = views_name(suite, job.spec.environment),
                     .session_start = session_start,
                     .jobs = options.jobs,
                     .metrics_only = options.metrics_only,
                     .live_port = options.live_port,
                     .parent = getpid()};
      // Whoever watches wants to see the mapping, not its result.
      if (options.cache && options.live_port == 0) order.maps = cache;
      if (!job.images.empty() && !job.spec.environment.is_recorded())
        order.images = images / job.images, order.images_limit = images_limit;
      const fs::path file = work.path() / (job.key + ".json");
      write_order(file, order);
      return std::vector<std::string>{"run-child", file.string()};
    };
    pool.forget = [&](const std::string& name) {
      std::error_code no_matter;
      if (!name.empty()) fs::remove_all(images / name, no_matter);
    };
    pool.say = options.say;
    pool.progress = options.progress;
    run_pending(store, std::move(mine), pool);
  }
  store.check();
  BenchResults made = load_results(store, suite, plan);
  if (!options.metrics_only) warn_missing_outputs(suite, made, options);
  return made;
}

}  // namespace mh
