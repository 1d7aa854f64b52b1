// SPDX-License-Identifier: Apache-2.0
#include "bench/run.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "bench/systems/ours.hpp"
#include "bench/world/lockstep.hpp"

namespace mh {
namespace {

// How far runs may drift apart; the studios keep three times as many pictures.
constexpr std::size_t kWindow = 8;
constexpr std::size_t kKept = 3 * kWindow;

/// Runs that see the same pictures: one level, one trial.
struct Group {
  std::size_t level = 0;
  int trial = 0;
  std::vector<std::size_t> runs;  ///< indices into the list of all runs
};

std::vector<Group> group(const std::vector<RunSpec>& specs) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const bool joins = !groups.empty() && groups.back().level == specs[i].level &&
                       groups.back().trial == specs[i].trial;
    if (!joins) groups.push_back({specs[i].level, specs[i].trial, {}});
    groups.back().runs.push_back(i);
  }
  return groups;
}

/// Adds up what all runs have done and passes it on.
class ProgressSum {
 public:
  ProgressSum(std::size_t runs, std::size_t work_per_run, std::function<void(double)> tell)
      : done_(runs, 0),
        all_(std::max<std::size_t>(1, runs * work_per_run)),
        tell_(std::move(tell)) {}
  /// A rewind takes nothing back: the furthest point counts.
  void reached(std::size_t run, std::size_t position) {
    const std::lock_guard lock(mutex_);
    if (position <= done_[run]) return;
    sum_ += position - done_[run];
    done_[run] = position;
    tell_(static_cast<double>(sum_) / static_cast<double>(all_));
  }

 private:
  std::mutex mutex_;
  std::vector<std::size_t> done_;
  std::size_t sum_ = 0, all_;
  std::function<void(double)> tell_;
};

class FinishAtEnd {
 public:
  FinishAtEnd(Lockstep& lockstep, std::size_t run) : lockstep_(lockstep), run_(run) {
    lockstep_.start(run_);
  }
  ~FinishAtEnd() { lockstep_.finish(run_); }
  FinishAtEnd(const FinishAtEnd&) = delete;
  FinishAtEnd& operator=(const FinishAtEnd&) = delete;

 private:
  Lockstep& lockstep_;
  std::size_t run_;
};

void run_group(const Group& group, const std::vector<RunSpec>& specs, const Suite& suite,
               const World& world, int jobs, const RunOptions& options,
               const SystemFactory& factory, ProgressSum& progress,
               std::vector<RunResult>& results) {
  const auto studio = [&](const DrivenPath& path) {
    return std::make_unique<FrameStudio>(world.renderer, world.robot.camera, path.camera,
                                         world.levels[group.level], kKept);
  };
  const auto mapping = studio(world.mapping);
  const auto second = world.second ? studio(*world.second) : nullptr;
  const RunPlace place{*mapping, second.get(), world.robot};

  Lockstep lockstep(group.runs.size(), jobs, kWindow);
  std::vector<std::exception_ptr> errors(group.runs.size());
  std::vector<std::jthread> threads;
  for (std::size_t member = 0; member < group.runs.size(); ++member)
    threads.emplace_back([&, member] {
      try {
        const FinishAtEnd turn(lockstep, member);
        const std::size_t run = group.runs[member];
        results[run] = run_one(
            specs[run], suite, factory(specs[run], suite, world), place,
            [&](std::size_t position) {
              lockstep.advance(member, position);
              progress.reached(run, position);
            },
            options.tamper);
      } catch (...) {
        errors[member] = std::current_exception();
      }
    });
  threads.clear();  // joins
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace

std::unique_ptr<System> make_system(const RunSpec& spec, const Suite& suite, const World& world) {
  SlamConfig config;
  config.semantics = suite.semantics;
  if (spec.system == SystemKind::kPlain) config.semantics = config.semantics.neutralised();
  return make_our_system(world.robot.camera, config, world.vocabulary);
}

std::vector<RunResult> run_all(const Suite& suite, const World& world, const RunOptions& options,
                               const SystemFactory& factory) {
  const std::vector<RunSpec> specs = expand(suite);
  const std::vector<Group> groups = group(specs);
  std::vector<RunResult> results(specs.size());

  std::size_t work =
      world.mapping.camera.size() + test_frames(world.mapping.camera.size(), suite.protocol).size();
  if (world.second) work += test_frames(world.second->camera.size(), suite.protocol).size();
  ProgressSum progress(specs.size(), work, options.progress);

  // Groups beside one another only as far as one group cannot use all places by itself.
  const auto members = static_cast<int>(groups.front().runs.size());
  const int side_by_side = std::max(1, options.jobs / members);
  const int jobs_per_group = std::max(1, options.jobs / side_by_side);
  for (std::size_t next = 0; next < groups.size();) {
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(side_by_side));
    {
      std::vector<std::jthread> threads;
      for (int k = 0; k < side_by_side && next < groups.size(); ++k, ++next)
        threads.emplace_back([&, k, which = next] {
          try {
            run_group(groups[which], specs, suite, world, jobs_per_group, options, factory,
                      progress, results);
          } catch (...) {
            errors[static_cast<std::size_t>(k)] = std::current_exception();
          }
        });
    }
    for (const std::exception_ptr& error : errors)
      if (error) std::rethrow_exception(error);
  }
  return results;
}

}  // namespace mh
