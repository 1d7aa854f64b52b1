// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "slam/io/temporary_folder.hpp"

namespace mh {

/// A file that is written piece by piece and appears under its name when it is finished; an
/// unfinished file is removed.
class OutputFile {
 public:
  /// @throws as make_output_folder(), throw_unwritable()
  explicit OutputFile(std::filesystem::path file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void append(std::string_view bytes);
  /// Overwrites bytes that were written before.
  void replace(std::uint64_t at, std::string_view bytes);
  std::uint64_t size() const { return size_; }
  void finish();

 private:
  void put(std::uint64_t at, std::string_view bytes);

  std::filesystem::path file_;
  TemporaryFolder work_;  ///< next to the file
  std::filesystem::path unfinished_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace mh
