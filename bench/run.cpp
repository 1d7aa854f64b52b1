// SPDX-License-Identifier: Apache-2.0
#include "bench/run.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include <fmt/format.h>

namespace mh {
namespace {

bool same_world(const RunSpec& a, const RunSpec& b) {
  return a.environment.name == b.environment.name && a.level == b.level;
}

/// Adds up what all runs have done and passes it on.
class ProgressSum {
 public:
  ProgressSum(std::size_t runs, const std::function<void(double)>& tell)
      : done_(runs, 0.0), tell_(tell) {}
  void reached(std::size_t run, double share) {
    const std::lock_guard lock(mutex_);
    sum_ += share - done_[run];
    done_[run] = share;
    tell_(sum_ / static_cast<double>(done_.size()));
  }

 private:
  std::mutex mutex_;
  std::vector<double> done_;
  double sum_ = 0;
  const std::function<void(double)>& tell_;
};

}  // namespace

std::vector<RunResult> run_all(const Suite& suite, const RunOptions& options) {
  const std::vector<RunSpec> specs = expand(suite);
  std::vector<RunResult> results(specs.size());
  ProgressSum progress(specs.size(), options.progress);
  for (std::size_t first = 0; first < specs.size();) {
    std::size_t end = first;
    while (end < specs.size() && same_world(specs[first], specs[end])) ++end;
    const World world = build_world(specs[first], options.jobs, options.say);
    options.say(fmt::format("{} runs of {} frames", end - first, world.mapping.camera.size()));

    std::atomic<std::size_t> next = first;
    std::mutex finishing;
    std::exception_ptr error;
    {
      std::vector<std::jthread> threads;
      for (int k = 0; k < options.jobs; ++k)
        threads.emplace_back([&] {
          try {
            for (std::size_t run = next++; run < end; run = next++) {
              RunResult result =
                  run_one(specs[run], world,
                          {.progress = [&, run](double share) { progress.reached(run, share); }});
              const std::lock_guard lock(finishing);
              options.finished(world, result);
              results[run] = std::move(result);
            }
          } catch (...) {
            const std::lock_guard lock(finishing);
            if (!error) error = std::current_exception();
            next = end;
          }
        });
    }
    if (error) std::rethrow_exception(error);
    first = end;
  }
  return results;
}

}  // namespace mh
