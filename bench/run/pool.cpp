// SPDX-License-Identifier: Apache-2.0
#include "bench/run/pool.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <memory>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "bench/run/forecast.hpp"
#include "bench/run/run_process.hpp"
#include "bench/run/signal_watch.hpp"
#include "bench/suite/run_spec.hpp"
#include "bench/systems/program_folder.hpp"
#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFirstGuess_mb = 1500;  // memory of one run, until a run has been measured
constexpr int kPoll_ms = 100;
constexpr auto kBeat = std::chrono::seconds(10);

double available_mb() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  double kb = 0;
  while (file >> word)
    if (word == "MemAvailable:" && file >> kb) return kb / 1024.0;
  return 1e9;  // unknown: no limit
}

struct Waiting {
  Job job;
  bool alone = false;  ///< must run alone, since it was killed from outside once
};

struct Running {
  Waiting what;
  std::unique_ptr<RunProcess> process;
  std::string cut_off;  ///< why we killed it; empty if we did not
};

class Pool {
 public:
  Pool(Store& store, std::vector<Job> jobs, const PoolOptions& options)
      : store_(store), options_(options), all_(jobs.size()) {
    for (Job& job : jobs) waiting_.push_back({std::move(job), false});
    require_mb_ = store.largest_rss_mb();
  }

  void work() {
    const SignalWatch watch;
    auto next_beat = Clock::now() + kBeat;
    estimate_waiting();
    report();
    while (!waiting_.empty() || !running_.empty()) {
      if (watch.signal() != 0) {
        give_up();
        throw Interrupted{watch.signal()};
      }
      start_what_fits();
      wait_a_moment();
      look_after_running();
      if (Clock::now() < next_beat) continue;
      store_.beat();
      next_beat = Clock::now() + kBeat;
    }
  }

 private:
  /// Ends every process and releases their claims.
  void give_up() {
    for (Running& r : running_) r.process->kill();
    std::vector<std::string> keys;
    for (const Running& r : running_) keys.push_back(r.what.job.key);
    running_.clear();  // waits for them
    remove_abandoned_folders(ProgramFolder::place());
    for (const std::string& key : keys) store_.release(key);
  }

  double require_mb() const { return require_mb_ > 0 ? require_mb_ : kFirstGuess_mb; }

  bool another_fits() const {
    if (running_.empty()) return true;
    if (running_.size() >= static_cast<std::size_t>(options_.jobs)) return false;
    double promised_mb = 0;
    for (const Running& r : running_)
      promised_mb += std::max(0.0, require_mb() - r.process->rss_mb());
    return available_mb() - promised_mb > require_mb();
  }

  /// Positions in waiting_, best first: runs whose images exist and are not in use, then those
  /// whose images no run has begun, then the others.
  std::vector<std::size_t> by_preference() const {
    std::set<std::string> in_use;
    for (const Running& r : running_) in_use.insert(r.what.job.images);
    const auto rank = [&](std::size_t i) {
      const std::string& images = waiting_[i].job.images;
      return in_use.contains(images) ? 2 : begun_.contains(images) ? 0 : 1;
    };
    std::vector<std::size_t> order(waiting_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, rank);
    return order;
  }

  void start_what_fits() {
    while (another_fits() && start_next()) estimate_waiting();
  }

  /// Called when runs begin or end, not at each of the thousands of progress reports.
  void estimate_waiting() {
    std::vector<const RunSpec*> waiting;
    for (const Waiting& w : waiting_) waiting.push_back(&w.job.spec);
    waiting_s_ = forecast_.of_all(waiting);
  }

  /// Starts a run, or notes that another process finished it; false if none can be started now.
  bool start_next() {
    const bool only_alone =
        std::all_of(waiting_.begin(), waiting_.end(), [](const Waiting& w) { return w.alone; });
    const bool one_is_alone = std::any_of(running_.begin(), running_.end(),
                                          [](const Running& r) { return r.what.alone; });
    for (const std::size_t i : by_preference()) {
      const auto status = store_.status(waiting_[i].job.key);
      const bool must_wait = waiting_[i].alone ? !only_alone || !running_.empty() : one_is_alone;
      if (!status && (must_wait || !store_.claim(waiting_[i].job.key))) continue;
      Waiting next = std::move(waiting_[i]);
      waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
      if (status)  // another process finished it
        note_end(next.job, *status == RunStatus::kDone);
      else
        start(std::move(next));
      return true;
    }
    return false;
  }

  std::filesystem::path work_file(const Job& job, const char* ending) const {
    return options_.work_folder / (job.key + ending);
  }

  void start(Waiting next) {
    const Job& job = next.job;
    begun_.insert(job.images);
    auto process = std::make_unique<RunProcess>(options_.executable, options_.arguments(job),
                                                work_file(job, ".log"));
    running_.push_back({std::move(next), std::move(process), ""});
  }

  void wait_a_moment() const {
    std::vector<pollfd> outputs;
    for (const Running& r : running_) outputs.push_back({r.process->output(), POLLIN, 0});
    ::poll(outputs.data(), outputs.size(), kPoll_ms);
    // A closed output always counts as readable: wait a little instead of spinning.
    for (const pollfd& output : outputs)
      if ((output.revents & POLLHUP) != 0) ::poll(nullptr, 0, 5);
  }

  void look_after_running() {
    bool news = false;
    for (std::size_t i = 0; i < running_.size();) {
      Running& r = running_[i];
      const double before = r.process->share();
      const std::string status = r.process->status();
      const auto end = r.process->poll();
      news = news || end || r.process->share() != before || r.process->status() != status;
      for (const std::string& stage : r.process->take_stages())
        options_.say(fmt::format("{}: {}", r.what.job.spec.name, stage));
      if (!end) {
        keep_within_limits(r);
        ++i;
        continue;
      }
      Running ended = std::move(r);
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
      settle(std::move(ended), *end);
    }
    if (news) report();
  }

  double time_limit_s(const RunSpec& spec) const {
    double limit_s = options_.time_limit_s;
    if (spec.episodes)
      limit_s += static_cast<double>(spec.episodes->count()) * spec.episodes->limit_s;
    return limit_s;
  }

  void keep_within_limits(Running& r) const {
    if (!r.cut_off.empty()) return;
    const double limit_s = time_limit_s(r.what.job.spec);
    if (options_.time_limit_s > 0 && r.process->age_s() > limit_s)
      r.cut_off = fmt::format("took longer than the limit of {:g} s", limit_s);
    else if (options_.memory_limit_mb > 0 && r.process->rss_mb() > options_.memory_limit_mb)
      r.cut_off =
          fmt::format("needed more memory than the limit of {:.0f} MB", options_.memory_limit_mb);
    if (!r.cut_off.empty()) r.process->kill();
  }

  void settle(Running ended, const ProcessEnd& end) {
    const Job& job = ended.what.job;
    require_mb_ = std::max(require_mb_, end.cost.max_rss_mb);
    if (end.good && store_.status(job.key) == RunStatus::kDone) {
      std::filesystem::remove(work_file(job, ".json"));
      std::filesystem::remove(work_file(job, ".log"));
      forecast_.note(job.spec, end.cost.wall_s);
      note_end(job, true);
      return;
    }
    const bool killed = end.signal == SIGKILL || end.signal == SIGTERM || end.signal == SIGHUP;
    if (killed && ended.cut_off.empty() && !ended.what.alone) {
      options_.say(
          fmt::format("{}: was killed from outside; will be tried again, alone", job.spec.name));
      store_.release(job.key);
      waiting_.push_back({job, true});
      return;
    }
    if (end.reported && end.code == kDiskFullCode && ended.cut_off.empty()) {
      give_up();
      store_.release(job.key);
      throw DiskFullError(end.message);
    }
    if (end.reported && end.code == kInputChangedCode && ended.cut_off.empty()) {
      give_up();
      store_.release(job.key);
      throw InputError(end.message);
    }
    const std::string error = describe(ended, end);
    store_.put_failure(job.key, job.spec, error, end.cost);
    options_.say(fmt::format("{}: failed: {}", job.spec.name, error));
    note_end(job, false);
  }

  static std::string describe(const Running& ended, const ProcessEnd& end) {
    if (!ended.cut_off.empty()) return ended.cut_off;
    if (end.signal != 0 || !end.reported) return unreported_end(end, ended.process->status());
    return end.code == kBadInputCode ? std::string(kBadInputMark) + end.message : end.message;
  }

  void note_end(const Job& job, bool good) {
    ++(good ? done_ : failed_);
    if (was_last(job, &Job::frames)) options_.forget(job.frames);
    if (was_last(job, &Job::images)) {
      begun_.erase(job.images);
      options_.forget(job.images);
    }
    estimate_waiting();
    report();
  }
  /// Whether no other waiting or running job has the same value of `seen`.
  bool was_last(const Job& job, std::string Job::*seen) const {
    const auto sees_it = [&](const Job& other) { return other.*seen == job.*seen; };
    return std::ranges::none_of(waiting_, sees_it, &Waiting::job) &&
           std::ranges::none_of(running_, sees_it,
                                [](const Running& r) -> const Job& { return r.what.job; });
  }

  void report() const {
    double sum = static_cast<double>(done_ + failed_);
    for (const Running& r : running_) sum += r.process->share();
    // The work is done when every run is settled, not when the last one reports that it is
    // finished.
    const bool over = done_ + failed_ == all_;
    PoolProgress progress{.share = over ? 1.0 : std::min(0.99, sum / static_cast<double>(all_)),
                          .done = done_,
                          .failed = failed_,
                          .to_go_s = over ? std::nullopt : to_go_s(),
                          .status = {}};
    for (const Running& r : running_)
      if (progress.status.empty() && !r.process->status().empty())
        progress.status = fmt::format("{}: {}", r.what.job.spec.name, r.process->status());
    options_.progress(progress);
  }

  std::optional<double> to_go_s() const {
    if (!waiting_s_) return std::nullopt;
    std::vector<RunAtWork> at_work;
    for (const Running& r : running_)
      at_work.push_back(
          {r.what.job.spec, r.process->age_s(), r.process->working_s(), r.process->share()});
    return forecast_.to_go_s(*waiting_s_, at_work, options_.jobs);
  }

  Store& store_;
  const PoolOptions& options_;
  std::size_t all_, done_ = 0, failed_ = 0;
  double require_mb_ = 0;  ///< largest memory of one run measured so far
  Forecast forecast_;
  std::vector<Waiting> waiting_;
  std::optional<double> waiting_s_;  ///< how long the waiting runs will take, if known
  std::vector<Running> running_;
  std::set<std::string> begun_;  // images that a run has begun to make
};

}  // namespace

void run_pending(Store& store, std::vector<Job> jobs, const PoolOptions& options) {
  Pool(store, std::move(jobs), options).work();
}

}  // namespace mh
