// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace mh::gazebo {

/// Collects warnings; keeps each once, with its number of occurrences.
class UniqueWarnings {
 public:
  void add(const std::string& what) { add(what, what); }

  /// @param thing  what the warning is about; only the first warning about it is kept
  void add(const std::string& what, const std::string& thing) {
    const auto place = std::ranges::find(collected_, thing, &Entry::thing);
    if (place != collected_.end())
      ++place->times;
    else
      collected_.push_back({thing, what, 1});
  }

  /// Appends them in the order in which they were first given.
  void append_to(std::vector<std::string>* warnings) const {
    if (warnings == nullptr) return;
    for (const auto& [thing, what, times] : collected_)
      warnings->push_back(times == 1 ? what : fmt::format("{} ({} times)", what, times));
  }

 private:
  struct Entry {
    std::string thing, what;
    int times;
  };
  std::vector<Entry> collected_;
};

}  // namespace mh::gazebo
