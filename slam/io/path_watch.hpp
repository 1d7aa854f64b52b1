// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>

namespace mh {

/// Notices if a path leads elsewhere for a while: a file, a folder or a link on the way to it is
/// moved, replaced or removed, even if it is put back before anybody looks (inotify). Other changes
/// in these folders do not count. Where the system offers no watch, nothing is noticed.
class PathWatch {
 public:
  explicit PathWatch(std::span<const std::filesystem::path> files);
  ~PathWatch();
  PathWatch(const PathWatch&) = delete;
  PathWatch& operator=(const PathWatch&) = delete;

  /// Call it now and then: the system keeps a limited number of changes.
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
