// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>

namespace mh {

/// Counts the files of a folder that any process has opened since this object was made (inotify).
/// This shows how far a program is in a recording, even if the program does not report it. Counts
/// nothing if the system has no inotify watches left.
class FramesRead {
 public:
  explicit FramesRead(const std::filesystem::path& folder);
  ~FramesRead();
  FramesRead(const FramesRead&) = delete;
  FramesRead& operator=(const FramesRead&) = delete;

  /// The number of different files so far.
  std::size_t count();

 private:
  int events_ = -1;
  std::set<std::string> names_;
};

}  // namespace mh
