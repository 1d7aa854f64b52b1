// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

namespace mh {

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
