// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace mh {

/// Hides files and folders from a program and whatever it starts; everything else stays visible. In
/// a mount namespace of its own, folders are covered by an empty one, files by /dev/null, and
/// shared memory (/dev/shm) holds only the program's own folder, so that it cannot touch another
/// program's images. A user without privileges needs a user namespace for that, in which the
/// program cannot remove the covers; a program run by root could. If the system allows no such
/// namespace, nothing is hidden.
class Hiding {
 public:
  /// @param hidden  what does not exist is left out
  /// @param needed  by the program: these, and folders that contain one of them, are not hidden
  /// @param own     a folder that the bench made for it, possibly in shared memory
  Hiding(std::span<const std::filesystem::path> hidden,
         std::span<const std::filesystem::path> needed, const std::filesystem::path& own);

  /// For a process that was forked to become the program: makes only system calls. Writes one line
  /// on what is hidden to standard error; nothing if nothing was to be hidden.
  void apply() const;

 private:
  std::vector<std::string> folders_, files_;
  bool memory_ = false;  ///< what others have in shared memory is hidden
  std::string own_;      ///< in shared memory; empty: elsewhere
  std::string user_map_, group_map_;
  std::string done_, left_;  ///< for the line
};

}  // namespace mh
