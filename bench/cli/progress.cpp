// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace mh::cli {
namespace {

std::size_t columns_of(std::FILE* terminal) {
  winsize size{};
  if (ioctl(fileno(terminal), TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return 80;
  return size.ws_col;
}

}  // namespace

std::string readable_time(double seconds) {
  const auto s = static_cast<long>(std::lround(std::max(0.0, seconds)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

std::string bar_line(std::string_view what, double done, std::string_view to_go,
                     std::string_view figures, std::size_t columns) {
  constexpr std::size_t kLongestBar = 40, kShortestBar = 8;
  std::string tail = fmt::format("] {:5.1f} %{}", 100 * done, to_go);
  const std::size_t around = what.size() + 2 + tail.size();  // the line without bar and figures
  const std::size_t room = columns > around + kShortestBar ? columns - around - kShortestBar : 0;
  while (figures.size() + 2 > room && !figures.empty()) {
    const std::size_t comma = figures.rfind(", ");
    figures = comma == std::string_view::npos ? std::string_view() : figures.substr(0, comma);
  }
  if (!figures.empty()) tail += fmt::format("; {}", figures);
  const std::size_t taken = what.size() + 2 + tail.size();
  const std::size_t bar = columns > taken ? std::min(kLongestBar, columns - taken) : 0;
  const auto full = static_cast<std::size_t>(done * static_cast<double>(bar));
  return fmt::format("{} [{}{}{}", what, std::string(full, '#'), std::string(bar - full, '.'), tail)
      .substr(0, columns);
}

Progress::Progress(std::string what, std::FILE* to)
    : what_(std::move(what)), to_(to), terminal_(isatty(fileno(to)) != 0) {}

Progress::~Progress() {
  end();
}

void Progress::end() {
  if (line_open_) fmt::print(to_, "\n");
  line_open_ = false;
  std::fflush(to_);
}

void Progress::say(std::string_view stage) {
  end();
  fmt::print(to_, "{}: {}\n", what_, stage);
  std::fflush(to_);
}

void Progress::share(double done, std::string_view figures) {
  constexpr double kEnough = 0.05;
  if (!first_share_) first_share_ = done;
  if (!measured_from_ && done > *first_share_) {
    measured_from_ = done;
    start_ = std::chrono::steady_clock::now();
  }
  std::optional<double> to_go_s;
  if (measured_from_ && done - *measured_from_ >= kEnough) {
    const double elapsed =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    to_go_s = elapsed * (1 - done) / (done - *measured_from_);
  }
  share(done, figures, to_go_s);
}

void Progress::share(double done, std::string_view figures, std::optional<double> to_go_s) {
  done = std::clamp(done, 0.0, 1.0);
  const int steps = terminal_ ? 200 : 10;
  // Products such as 0.3 * 10 may be slightly less than the step that they should reach.
  const int step = static_cast<int>(done * steps + 1e-9);
  if (step == last_step_ && (!terminal_ || figures == last_figures_)) return;
  last_step_ = step;
  last_figures_ = figures;
  const std::string to_go =
      to_go_s && done < 1 ? ", " + readable_time(*to_go_s) + " to go" : std::string();
  if (terminal_) {
    // The last column is left free: some terminals wrap as soon as it is written.
    fmt::print(to_, "\r{}\x1b[K", bar_line(what_, done, to_go, figures, columns_of(to_) - 1));
    line_open_ = true;
  } else {
    fmt::print(to_, "{}: {:.0f} %{}{}{}\n", what_, 100 * done, to_go, figures.empty() ? "" : "; ",
               figures);
  }
  std::fflush(to_);
}

}  // namespace mh::cli
