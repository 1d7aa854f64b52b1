// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

namespace mh::cli {

/// Reports the progress of long work with the time remaining: on a terminal, a bar that redraws
/// itself within one line; elsewhere, a plain line at every tenth of the work.
class Progress {
 public:
  explicit Progress(std::string what, std::FILE* to = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void say(std::string_view stage);
  /// The time remaining is shown once 1/20 of the work has been measured. Measuring starts with the
  /// first progress, since the preparation before it would bias the estimate.
  /// @param done     in [0, 1]
  /// @param figures  shown after the bar: status of the work
  void share(double done, std::string_view figures = {});
  /// The same with the caller's own estimate of the time remaining; nullopt if it is not known yet.
  void share(double done, std::string_view figures, std::optional<double> to_go_s);
  /// Ends the bar's line: what is printed next starts on a new line.
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

/// Returns one line of at most `columns` characters. If it would be longer, first the bar shrinks,
/// then figures are dropped from the end.
/// @param figures  separated by ", "
std::string bar_line(std::string_view what, double done, std::string_view to_go,
                     std::string_view figures, std::size_t columns);

/// "3 min 20 s"
std::string readable_time(double seconds);

}  // namespace mh::cli
