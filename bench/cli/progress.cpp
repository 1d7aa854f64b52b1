// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace mh::cli {

std::string readable_time(double seconds) {
  const auto s = static_cast<long>(std::lround(std::max(0.0, seconds)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

Progress::Progress(std::string what)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  end_line();
}

void Progress::end_line() {
  if (line_open_) fmt::print(stderr, "\n");
  line_open_ = false;
}

void Progress::say(std::string_view stage) {
  end_line();
  fmt::print(stderr, "{}: {}\n", what_, stage);
  std::fflush(stderr);
}

void Progress::share(double done, std::string_view figures) {
  done = std::clamp(done, 0.0, 1.0);
  if (!started_) {
    started_ = true;
    first_share_ = done;
    start_ = std::chrono::steady_clock::now();
  }
  const int steps = terminal_ ? 200 : 10;
  const int step = static_cast<int>(done * steps);
  if (step == last_step_ && figures == last_figures_) return;
  last_step_ = step;
  last_figures_ = figures;
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::string to_go =
      done > first_share_ + 0.005 && done < 1
          ? ", " + readable_time(elapsed * (1 - done) / (done - first_share_)) + " to go"
          : "";
  if (terminal_) {
    constexpr int kBar = 40;
    const int full = static_cast<int>(done * kBar);
    fmt::print(stderr, "\r{} [{}{}] {:5.1f} %{}{}{}   ", what_, std::string(full, '#'),
               std::string(kBar - full, '.'), 100 * done, to_go, figures.empty() ? "" : "; ",
               figures);
    line_open_ = true;
  } else {
    fmt::print(stderr, "{}: {:.0f} %{}{}{}\n", what_, 100 * done, to_go,
               figures.empty() ? "" : "; ", figures);
  }
  std::fflush(stderr);
}

}  // namespace mh::cli
