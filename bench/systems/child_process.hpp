// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "bench/suite/outside_program.hpp"
#include "bench/systems/outside_error.hpp"
#include "bench/systems/watcher.hpp"

namespace mh {

/// Opens a new file for what a program prints, replacing an earlier one; returns -1 and sets errno
/// if that fails.
int new_log(const std::filesystem::path& file);

/// An outside program running under a watcher, with limits on time, memory and disk use. The
/// program and all its descendants are killed when this object is destroyed or this process ends,
/// for whatever reason (for exceptions see watcher.hpp). Every failure is an OutsideError naming
/// the program, its command, what it did and the last line of its log.
class ChildProcess {
 public:
  enum class Talk { kNo, kOverPipes };

  /// Starts `command` with /bin/sh in program.folder.
  /// @param talk    kOverPipes: send() and read_line() reach its standard input and output; kNo: it
  ///                reads nothing and its output goes to the log. Its standard error always goes to
  ///                the log.
  /// @param log     file for the log; a program whose log exceeds 64 MB is stopped
  /// @param folder  where the program may write: its growth counts toward the disk limit, and it is
  ///                removed if this process dies before the object is destroyed
  ChildProcess(const OutsideProgram& program, std::string command, Talk talk,
               const std::filesystem::path& log, const std::filesystem::path& folder);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Writes a line. `doing` describes the work in messages: "track (request 7)".
  void send(std::string_view line, std::string_view doing);
  /// Reads the next line of its output, without the newline; an error if none arrives within the
  /// limit.
  std::string read_line(double limit_s, std::string_view doing);
  /// Waits until it ends. Anything but exit code 0 within the limit is an error.
  /// @param meanwhile  called about ten times a second
  void wait_for_success(
      double limit_s, const std::function<void()>& meanwhile = [] {});
  /// Closes its input, which signals it to end, and kills it if it has not ended within the limit.
  /// Any end other than exit code 0 is an error.
  void finish(double limit_s);

  /// Throws an OutsideError about what the program did ("exited with code 3"), after ending the
  /// program. Files in the log's folder and in `folder` are named relative to these folders, so
  /// that the same failure has the same message everywhere.
  [[noreturn]] void fail(std::string_view what);

  /// Growth of its folder since the start, MB.
  double written_mb() const;

 private:
  void check_limits(std::string_view doing);
  /// Describes how it ended; waits at most `wait_ms` for its end.
  std::string ending(int wait_ms);
  bool ended_well();

  const OutsideProgram program_;
  const std::string command_;
  const std::filesystem::path log_, folder_;
  double size_before_mb_ = 0;                        ///< of the folder
  std::chrono::steady_clock::time_point next_look_;  ///< when to check its limits again
  int to_child_ = -1, from_child_ = -1, log_file_ = -1;
  std::optional<Watcher> watcher_;
  std::string unread_;
};

}  // namespace mh
