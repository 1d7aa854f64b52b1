// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

namespace mh {

/// Thrown when the user interrupted the work (Ctrl-C, SIGTERM, SIGHUP): every process has ended;
/// finished results are kept.
struct Interrupted {
  int signal = 0;
  bool goes_on = true;  ///< whether the same command continues from what is finished
};

inline constexpr int kInterruptedCode = 130;  ///< exit code

/// The last line that an interrupted command prints.
const char* interrupted_line(bool goes_on);

/// From now on SIGINT, SIGTERM and SIGHUP end the program at once, with interrupted_line() and code
/// 130; while a SignalWatch exists, it handles them instead.
void tell_of_interrupts();
/// From now on, the line printed after tell_of_interrupts() says that the same command resumes from
/// what is finished.
void interrupts_go_on();

/// During its lifetime, records SIGINT, SIGTERM and SIGHUP instead of terminating.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  /// The last signal received; 0 = none.
  int signal() const;

 private:
  struct sigaction old_int_, old_term_, old_hangup_;
};

}  // namespace mh
