// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>

namespace mh {

/// A command to be started under a watcher; all of it outlives the call that starts it alone.
struct WatchedCommand {
  const char* folder = nullptr;   ///< where it runs
  const char* command = nullptr;  ///< for /bin/sh
  int in = -1;                    ///< its standard input
  int out = -1;                   ///< its standard output; -1: the log
  int log = -1;                   ///< file for its standard error
  std::uint64_t log_limit_bytes = 0;
  std::uint64_t file_limit_bytes = 0;  ///< of each file that it writes; 0: none
  const char* scratch = "";            ///< removed if this process ends before the watcher
};

/// How a watched command ended.
struct WatchedEnd {
  enum Kind : int {
    kNotStarted,   ///< value: errno
    kEnded,        ///< value: its wait status; all that it had started is gone, too
    kTooMuchSaid,  ///< its log reached its limit: it was killed
    kUnknown,      ///< its watcher was killed
  };
  Kind kind = kUnknown;
  int value = 0;
};

/// A process that stands between this one and a command: the command's parent, and that of whatever
/// it leaves behind (PR_SET_CHILD_SUBREAPER), in whatever session or process group. It ends all of
/// them when the command has ended, when this object goes, or when this process does, however that
/// came about. Only processes that another one started (a daemon on request), or that this user may
/// not kill, escape; and should the watcher itself be killed, all but the command's own.
class Watcher {
 public:
  /// @throws MachineError if no process could be started
  explicit Watcher(const WatchedCommand& command);
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  /// Ends the command and all that it started; they are gone when this returns.
  void end_all();
  /// The end, once it was told; waits so long for it at most.
  std::optional<WatchedEnd> end(int wait_ms);
  /// Becomes readable with the end.
  int news() const { return news_; }
  /// Resident memory of the command and all that it started, MB.
  double resident_mb() const;

 private:
  pid_t process_ = -1;
  int life_ = -1;  ///< closed by the end of this process at the latest
  int news_ = -1;
  std::optional<WatchedEnd> end_;
};

}  // namespace mh
