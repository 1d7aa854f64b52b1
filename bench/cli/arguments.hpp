// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include <CLI/CLI.hpp>

namespace mh::cli {

/// A finite number from `least` to `greatest`. (CLI::Range takes "nan": it is neither too small nor
/// too large.)
CLI::Validator number_between(double least, double greatest);

/// A seed: a whole number from 0 to 2^64 - 1, where parsing alone would let others wrap round.
CLI::Validator seed_number();

/// Finds out before the work whether a file can be written there; makes its folder.
/// @throws InputError naming file or folder; DiskFullError.
void need_writable(const std::filesystem::path& file);

/// The folder that a command writes into, made before the work: one that cannot be written costs no
/// minutes. Work that is refused before it wrote anything leaves no empty folder.
class OutputFolder {
 public:
  /// @throws as make_output_folder()
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  std::vector<std::filesystem::path> made_;  // innermost first
};

}  // namespace mh::cli
