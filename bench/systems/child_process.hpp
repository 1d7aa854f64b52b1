// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>

#include "bench/systems/outside_program.hpp"

namespace mh {

/// A running outside program in a process group of its own, with time and memory limits. The group
/// is killed when this object goes, or this process, however that came about. Every failure is an
/// OutsideError naming program, command, what it did and the last line that it wrote to its log.
class ChildProcess {
 public:
  enum class Talk { kNo, kOverPipes };

  /// Starts `command` by /bin/sh in program.folder.
  /// @param talk  kOverPipes: send() and read_line() reach its standard input and output; kNo: it
  ///              reads nothing and its output goes to the log. Its errors always go to the log.
  /// @param scratch  folder that is removed should this process die before the object goes
  ChildProcess(const OutsideProgram& program, std::string command, Talk talk,
               std::filesystem::path log, const std::filesystem::path& scratch = {});
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
  /// the log's folder and in `scratch` are named relative to it: the same failure has the same
  /// message wherever it happens.
  [[noreturn]] void fail(std::string_view what);

 private:
  bool try_reap(int options);
  void kill_group();
  void start_watcher();
  void check_memory(std::string_view doing);
  /// How it ended, for a program that closed its pipe; waits a moment for it to do so.
  std::string ending();

  const OutsideProgram program_;
  const std::string command_;
  const std::filesystem::path log_, scratch_;
  pid_t pid_ = -1;
  bool reaped_ = false;
  int status_ = 0;
  std::chrono::steady_clock::time_point next_look_;  ///< at its memory
  int to_child_ = -1, from_child_ = -1;
  pid_t watcher_ = -1;
  int to_watcher_ = -1;  ///< closed by the end of this process at the latest
  std::string unread_;
};

}  // namespace mh
