// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "bench/plan/outside_program.hpp"
#include "bench/systems/outside_error.hpp"
#include "bench/systems/watcher.hpp"

namespace mh {

/// A running outside program under a watcher, with limits of time, memory and what it writes. It
/// and all that it started are ended when this object goes, or this process, however that came
/// about (watcher.hpp says what may escape). Every failure is an OutsideError naming program,
/// command, what it did and the last line that it wrote to its log.
class ChildProcess {
 public:
  enum class Talk { kNo, kOverPipes };

  /// Starts `command` by /bin/sh in program.folder.
  /// @param talk  kOverPipes: send() and read_line() reach its standard input and output; kNo: it
  ///              reads nothing and its output goes to the log. Its errors always go to the log.
  /// @param log     beyond 64 MB the program is stopped
  /// @param folder  what the program may write into: counts against its limit, and is removed
  ///                should this process die before the object goes
  ChildProcess(const OutsideProgram& program, std::string command, Talk talk,
               const std::filesystem::path& log, const std::filesystem::path& folder);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Writes a line. `doing` names the work for messages: "track (request 7)".
  void send(std::string_view line, std::string_view doing);
  /// The next line of its output, without its end, at the latest after the limit.
  std::string read_line(double limit_s, std::string_view doing);
  /// Waits for its end. Anything but exit code 0 within the limit is an error.
  void wait_for_success(double limit_s);
  /// Closes its input, by which it is told to end, and kills it if it has not after the limit. Any
  /// other end than exit code 0 is an error.
  void finish(double limit_s);

  /// An OutsideError about what the program did: "exited with code 3". Ends the program. Files in
  /// the log's folder and in `folder` are named relative to it: the same failure has the same
  /// message wherever it happens.
  [[noreturn]] void fail(std::string_view what);

 private:
  void check_limits(std::string_view doing);
  /// How it ended; waits for it to do so.
  std::string ending(int wait_ms);
  bool ended_well();

  const OutsideProgram program_;
  const std::string command_;
  const std::filesystem::path log_, folder_;
  double size_before_mb_ = 0;                        ///< of the folder
  std::chrono::steady_clock::time_point next_look_;  ///< at its limits
  int to_child_ = -1, from_child_ = -1;
  std::optional<Watcher> watcher_;
  std::string unread_;
};

}  // namespace mh
