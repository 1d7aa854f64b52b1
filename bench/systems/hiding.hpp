// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace mh {

/// Hides files and folders from a program and whatever it starts; everything else remains visible.
/// In the program's own mount namespace, folders are covered by an empty one, files by /dev/null,
/// and shared memory (/dev/shm) holds only the program's own folder, so that it cannot touch
/// another program's images. For users without privileges this requires a user namespace, in which
/// the program cannot remove the covers; a program run by root could. If the system does not allow
/// these namespaces, nothing is hidden.
class Hiding {
 public:
  /// @param hidden  paths that do not exist are ignored
  /// @param needed  paths that the program needs: these, and folders that contain one of them, are
  ///                not hidden
  /// @param own     a folder that the bench made for the program, possibly in shared memory
  /// @param shared_memory_mb  how much its own shared memory holds; 0: as much as the system allows
  Hiding(std::span<const std::filesystem::path> hidden,
         std::span<const std::filesystem::path> needed, const std::filesystem::path& own,
         double shared_memory_mb);

  /// Call it in the process that was forked to become the program: it makes only system calls.
  /// Writes a line about what is hidden to standard error, or nothing if there was nothing to hide.
  void apply() const;

 private:
  std::vector<std::string> folders_, files_;
  bool memory_ = false;         ///< other programs' shared memory is hidden
  std::string memory_options_;  ///< for mount()
  std::string own_;             ///< the own folder, if in shared memory; else empty
  std::string user_map_, group_map_;
  std::string done_, left_;  ///< parts of apply()'s line
};

}  // namespace mh
