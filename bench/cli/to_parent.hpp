// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace mh::cli {

/// What the process of a run tells the one that started it, on standard output, as RunProcess
/// reads it.
class ToParent {
 public:
  void say(std::string_view stage);
  /// In steps of half a percent.
  void share(double share);
  /// Frames pass faster than anyone can read; what begins with another word is told at once.
  void status(std::string_view status);

 private:
  int last_step_ = -1;
  std::chrono::steady_clock::time_point told_;
  std::string last_word_;
};

}  // namespace mh::cli
