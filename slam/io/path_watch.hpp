// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>

namespace mh {

/// Detects (with inotify) whether a path was redirected, even temporarily: a file, a folder or a
/// link along it was moved, replaced or removed. Other changes in these folders do not count. On
/// systems without inotify, nothing is detected.
class PathWatch {
 public:
  explicit PathWatch(std::span<const std::filesystem::path> files);
  ~PathWatch();
  PathWatch(const PathWatch&) = delete;
  PathWatch& operator=(const PathWatch&) = delete;

  /// Call it regularly: the system queues a limited number of changes.
  /// @throws InputChanged naming what was moved since the watch began
  void require_unmoved();

 private:
  void follow(const std::filesystem::path& path, int links);

  struct Folder {
    std::filesystem::path path;
    std::set<std::string> names;
  };
  int watch_ = -1;
  std::map<int, Folder> folders_;  ///< by the watch's number
};

}  // namespace mh
