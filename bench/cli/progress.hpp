// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

namespace mh::cli {

/// Tells how far long work has come, with the time to go: a bar that is drawn over itself and stays
/// within one line on a terminal, a plain line every tenth of the work elsewhere.
class Progress {
 public:
  explicit Progress(std::string what, std::FILE* to = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void say(std::string_view stage);
  /// The time to go is told once a twentieth of the work was measured, from the first that was
  /// done: preparations before it would make it look slow.
  /// @param done     in [0, 1]
  /// @param figures  shown behind: how the work stands
  void share(double done, std::string_view figures = {});
  /// The same where the caller knows better how long it will take; nullopt: nobody knows yet.
  void share(double done, std::string_view figures, std::optional<double> to_go_s);
  /// Leaves the bar's line: what is printed next begins a line of its own.
  void end();

 private:
  std::string what_;
  std::FILE* to_;
  bool terminal_;
  bool line_open_ = false;
  std::optional<double> first_share_, measured_from_;
  int last_step_ = -1;
  std::string last_figures_;
  std::chrono::steady_clock::time_point start_;
};

/// One line of at most `columns` characters: the bar gives way first, then the last figures do.
/// @param figures  parted by ", "
std::string bar_line(std::string_view what, double done, std::string_view to_go,
                     std::string_view figures, std::size_t columns);

/// "3 min 20 s"
std::string readable_time(double seconds);

}  // namespace mh::cli
