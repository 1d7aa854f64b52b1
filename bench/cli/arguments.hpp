// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "bench/plan/shipped.hpp"
#include "slam/core/read_record.hpp"

namespace mh::cli {

/// A finite number from `least` to `greatest`. (CLI::Range takes "nan": it is neither too small nor
/// too large.)
CLI::Validator number_between(double least, double greatest);

/// A seed: a whole number from 0 to 2^64 - 1, where parsing alone would let others wrap round.
CLI::Validator seed_number();

/// One of some words; a slip is told the nearest of them.
CLI::Validator one_of_words(std::vector<std::string> words);

/// Puts the file that a word stands for in its place (find_shipped, find_scene for scenes); leaves
/// an empty one alone.
void resolve(std::string& word, Shipped what);

/// Finds out before the work whether a file can be written there; makes its folder.
/// @param read  what the command reads: none of it is overwritten
/// @throws InputError naming file or folder; DiskFullError.
void need_writable(const std::filesystem::path& file,
                   const std::vector<std::filesystem::path>& read = {});

/// Finds out, before anything is written, whether a file to be written is one that was read: of a
/// scene that is every file it was loaded from.
/// @throws InputError naming the file.
void need_not_read(const std::filesystem::path& file, const ReadRecord& record);

/// The folder that a command writes into, made before the work: one that cannot be written costs no
/// minutes. Work that is refused before it wrote anything leaves no empty folder. A file in it,
/// `.modelhouse`, names the commands that wrote there: what they wrote they may replace.
class OutputFolder {
 public:
  /// @param command  "drive", as the user calls it
  /// @param names    of what it is going to write there
  /// @throws InputError if something of such a name is there that the command did not write; as
  ///         make_output_folder()
  OutputFolder(const std::filesystem::path& folder, const std::string& command,
               std::vector<std::string> names);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  bool holds_any() const;

  const std::filesystem::path folder_;
  const std::vector<std::string> names_;
  std::optional<std::string> mark_before_;   // what .modelhouse held; engaged if it was changed
  std::vector<std::filesystem::path> made_;  // innermost first
};

}  // namespace mh::cli
