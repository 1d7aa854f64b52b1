// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string>

namespace mh {

/// The digests of files that are written into a folder one after the other, kept in its
/// `checksums.txt`, by which an interrupted command recognizes its own files. Safe to call from
/// several threads at once.
class FileChecksums {
 public:
  static constexpr const char* kName = "checksums.txt";

  /// Reads what an interrupted command left.
  explicit FileChecksums(std::filesystem::path folder);
  /// Notes what the files contain. @throws as read_file(), throw_unwritable()
  void add(std::span<const std::filesystem::path> files);
  /// Whether the files are there and contain what was noted; false if one was not noted.
  bool hold(std::span<const std::filesystem::path> files) const;
  /// Writes all digests, sorted by file; nothing if there are none.
  /// @throws InputChanged naming a file that does not contain what was noted
  void finish();

 private:
  std::string name_of(const std::filesystem::path& file) const;

  std::filesystem::path folder_;
  mutable std::mutex mutex_;                      ///< guards the file and digests_
  std::map<std::string, std::uint64_t> digests_;  ///< by path in the folder
};

}  // namespace mh
