// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>

namespace mh {

class Hiding;

/// A command to run under a watcher; what it points to need only outlive the call that starts it.
struct WatchedCommand {
  const char* folder = nullptr;   ///< where it runs
  const char* command = nullptr;  ///< for /bin/sh
  int in = -1;                    ///< its standard input
  int out = -1;                   ///< its standard output; -1: the log
  int log = -1;                   ///< file for its standard error
  std::uint64_t log_limit_bytes = 0;
  std::uint64_t file_limit_bytes = 0;  ///< per file that it writes; 0: unlimited
  const char* scratch = "";  ///< folder that is removed if this process ends before the watcher
  const Hiding* hiding = nullptr;  ///< hides files from the command; null: nothing is hidden
};

/// How a watched command ended.
struct WatchedEnd {
  enum Kind : int {
    kNotStarted,   ///< value: errno
    kEnded,        ///< value: its wait status; all its descendants are gone, too
    kTooMuchSaid,  ///< its log reached the limit, so it was killed
    kUnknown,      ///< its watcher was killed
  };
  Kind kind = kUnknown;
  int value = 0;
};

/// A process between this one and a command: the parent of the command and of whatever the command
/// leaves behind (PR_SET_CHILD_SUBREAPER), in whatever session or process group. It kills all of
/// them when the command has ended, when this object is destroyed, or when this process ends, for
/// whatever reason. The only processes that escape are those that an unrelated process (such as a
/// daemon) started on request and those that this user may not kill. If the watcher itself is
/// killed, all but the command's own process escape.
class Watcher {
 public:
  /// @throws MachineError if the process cannot be started
  explicit Watcher(const WatchedCommand& command);
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  /// Kills the command and all its descendants; they are gone when this returns.
  void end_all();
  /// Returns how the command ended, once that is reported; waits for at most `wait_ms`.
  std::optional<WatchedEnd> end(int wait_ms);
  /// Becomes readable when the command ends.
  int news() const { return news_; }
  /// Resident memory of the command and all its descendants, MB.
  double resident_mb() const;

 private:
  pid_t process_ = -1;
  int life_ = -1;  ///< closed at the latest when this process ends
  int news_ = -1;
  std::optional<WatchedEnd> end_;
};

}  // namespace mh
