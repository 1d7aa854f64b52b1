// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/store/store.hpp"

namespace mh {

/// What a run's process returns when it met a full disk: no fault of the run.
inline constexpr int kDiskFullCode = 4;
/// That it read other files than those that its key was made of.
inline constexpr int kInputChangedCode = 5;
/// ... or bad input that shows in the work alone.
inline constexpr int kBadInputCode = 2;

/// How a line begins that tells where a run stands; the latest counts.
inline constexpr char kStatusMark = '~';

/// How a process ended.
struct ProcessEnd {
  bool good = false;
  int signal = 0;       ///< that ended it; 0 = it returned
  int code = 0;         ///< that it returned
  std::string message;  ///< the last line of its standard error
  RunCost cost;
};

/// A process of our own executable that works off one run. It dies with this one. What it prints on
/// standard output are shares of the work done, one per line, and the names of long stages.
class RunProcess {
 public:
  /// @param log  file for its standard error
  RunProcess(const std::filesystem::path& executable, const std::vector<std::string>& arguments,
             std::filesystem::path log);
  /// Kills it if it still runs.
  ~RunProcess();
  RunProcess(const RunProcess&) = delete;
  RunProcess& operator=(const RunProcess&) = delete;

  /// Its end, once; nullopt while it runs.
  std::optional<ProcessEnd> poll();
  void kill();

  double share() const { return share_; }  ///< of its work done, as of the last poll
  /// The stages that it has told since they were taken last.
  std::vector<std::string> take_stages();
  /// Where the run stands, in its own words; "" before it told.
  const std::string& status() const { return status_; }
  double age_s() const;
  /// Seconds since it told of work done for the first time: without light and other preparations.
  double working_s() const;
  double rss_mb() const;
  int output() const { return output_; }  ///< readable when it told something

 private:
  void read_shares();

  std::filesystem::path log_;
  pid_t process_ = -1;
  int output_ = -1;
  std::string unread_;
  std::vector<std::string> stages_;
  std::string status_;
  double share_ = 0;
  std::chrono::steady_clock::time_point start_, first_share_;
};

/// Called by such a process: it is killed when `parent` dies.
void die_with(pid_t parent);

}  // namespace mh
