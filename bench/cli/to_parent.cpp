// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/to_parent.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "bench/run/run_process.hpp"

namespace mh::cli {

void ToParent::say(std::string_view stage) {
  fmt::print("{}\n", stage);
  std::fflush(stdout);
}

void ToParent::share(double share) {
  const int step = static_cast<int>(200 * share);
  if (step == last_step_) return;
  last_step_ = step;
  fmt::print("{:.4f}\n", share);
  std::fflush(stdout);
}

void ToParent::status(std::string_view status) {
  constexpr auto kBetween = std::chrono::milliseconds(500);
  const auto now = std::chrono::steady_clock::now();
  const std::string word(status.substr(0, status.find(' ')));
  if (word == last_word_ && now - told_ < kBetween) return;
  told_ = now;
  last_word_ = word;
  fmt::print("{}{}\n", kStatusMark, status);
  std::fflush(stdout);
}

}  // namespace mh::cli
