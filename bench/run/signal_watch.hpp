// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

namespace mh {

/// Thrown when the user interrupted the work (Ctrl-C, SIGTERM): every process has ended, what is
/// finished is kept.
struct Interrupted {
  int signal = 0;
  bool goes_on = true;  ///< whether the same command resumes from what is finished
};

/// During its lifetime, records SIGINT and SIGTERM instead of terminating.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  /// The signal that came last; 0 = none.
  int signal() const;

 private:
  struct sigaction old_int_, old_term_;
};

}  // namespace mh
