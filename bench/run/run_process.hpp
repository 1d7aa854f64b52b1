// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/store/store.hpp"

namespace mh {

/// Exit code of a run's process on a full disk: not the run's fault.
inline constexpr int kDiskFullCode = 4;
/// Exit code if the input files changed since the run's key was made.
inline constexpr int kInputChangedCode = 5;
/// Exit code on bad input that is found only during the run.
inline constexpr int kBadInputCode = 2;

/// Beginning of a line in which Modelhouse reports an error.
inline constexpr std::string_view kErrorMark = "modelhouse: error: ";

/// First character of a line that reports a run's status; the latest counts.
inline constexpr char kStatusMark = '~';

/// How a process ended.
struct ProcessEnd {
  bool good = false;
  int signal = 0;         ///< signal that killed it; 0 if it exited
  int code = 0;           ///< exit code
  std::string message;    ///< the last line of its standard error
  bool reported = false;  ///< the message is an error that Modelhouse itself reported
  RunCost cost;
};

/// Why a process that reported no error ended: its signal or exit code, and what it was last doing.
/// @param status  RunProcess::status()
std::string unreported_end(const ProcessEnd& end, const std::string& status);

/// A process of our own executable that executes one run. It dies with the process that started it.
/// Each line that it prints on standard output is the share of the work done, the name of a long
/// stage, or a status.
class RunProcess {
 public:
  /// @param log  file for its standard error
  RunProcess(const std::filesystem::path& executable, const std::vector<std::string>& arguments,
             std::filesystem::path log);
  /// Kills the process if it is still running.
  ~RunProcess();
  RunProcess(const RunProcess&) = delete;
  RunProcess& operator=(const RunProcess&) = delete;

  /// Returns, only once, how it ended; nullopt while it is running.
  std::optional<ProcessEnd> poll();
  void kill();

  double share() const { return share_; }  ///< share of its work done, as of the last poll
  /// Returns the stages that it has reported since the last call.
  std::vector<std::string> take_stages();
  /// The run's latest status line; "" before the first.
  const std::string& status() const { return status_; }
  double age_s() const;
  /// Seconds since it first reported progress: excludes baking light and other preparation.
  double working_s() const;
  double rss_mb() const;
  int output() const { return output_; }  ///< readable when it has reported something

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

/// Called by a run's process, so that it is killed when `parent` dies.
void die_with(pid_t parent);

}  // namespace mh
