// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace mh::gazebo {

/// Warnings, each once with the number of times that it was given.
class ToldOnce {
 public:
  void tell(std::string what) {
    const auto place = std::ranges::find(told_, what, &Entry::first);
    if (place != told_.end())
      ++place->second;
    else
      told_.emplace_back(std::move(what), 1);
  }

  /// In the order in which they were first given.
  void hand_over(std::vector<std::string>* warnings) const {
    if (warnings == nullptr) return;
    for (const auto& [what, times] : told_)
      warnings->push_back(times == 1 ? what : fmt::format("{} ({} times)", what, times));
  }

 private:
  using Entry = std::pair<std::string, int>;
  std::vector<Entry> told_;
};

}  // namespace mh::gazebo
