// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace mh {

/// Keeps files and folders from a program and whatever it starts, and leaves it all the rest: in a
/// mount namespace of its own, a folder is covered by an empty one, a file by /dev/null, and shared
/// memory (/dev/shm) holds nothing but the program's own folder, so that it cannot touch the images
/// of another. A user
/// without privileges needs a user namespace for that, in which the program cannot take the covers
/// off; the program of root could. Where the system allows no such namespace, nothing is hidden.
class Hiding {
 public:
  /// @param hidden  what is not there is left out
  /// @param needed  of the program: a folder that holds one of them, and one of them, is not hidden
  /// @param own     a folder that the bench made for it; in shared memory, perhaps
  Hiding(std::span<const std::filesystem::path> hidden,
         std::span<const std::filesystem::path> needed, const std::filesystem::path& own);

  /// For a process that was forked to become the program: makes system calls alone. Writes to
  /// standard error what holds, in one line; nothing if nothing was to be hidden.
  void apply() const;

 private:
  std::vector<std::string> folders_, files_;
  std::string own_;  ///< in shared memory; empty: it is elsewhere
  std::string user_map_, group_map_;
  std::string done_, left_;  ///< for the line
};

}  // namespace mh
