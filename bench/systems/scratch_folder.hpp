// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mh {

/// A temporary folder, in memory if possible, in which a program may do anything. Each write
/// creates a new file in the original folder: nothing that the program put in place of a file, or
/// of the folder, is opened or followed. Removed at the end, whatever the program did to it.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Writes a file, replacing the one of that name.
  /// @returns what the program did to prevent it; empty if the file was written
  /// @throws DiskFullError
  [[nodiscard]] std::string write(const char* name, std::string_view content) const;

 private:
  bool is_in_place() const;

  std::filesystem::path path_;
  int folder_ = -1;
};

}  // namespace mh
