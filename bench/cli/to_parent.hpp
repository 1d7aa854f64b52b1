// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace mh::cli {

/// What the process of a run reports to the one that started it, on standard output, as RunProcess
/// reads it.
class ToParent {
 public:
  void say(std::string_view stage);
  /// Sent in steps of half a percent.
  void share(double share);
  /// Frames pass faster than anyone can read; a status with another first word is sent at once.
  void status(std::string_view status);

 private:
  int last_step_ = -1;
  std::chrono::steady_clock::time_point told_;
  std::string last_word_;
};

}  // namespace mh::cli
