// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "bench/suite/shipped.hpp"
#include "slam/io/read_record.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh::cli {

/// Accepts a finite number from `least` to `greatest`. (CLI::Range also accepts "nan", which is
/// neither too small nor too large.)
CLI::Validator number_between(double least, double greatest);

/// Accepts a seed: an integer from 0 to 2^64 - 1. Without this check, parsing would let other
/// numbers wrap around.
CLI::Validator seed_number();

/// Accepts one of the given words; for a misspelled word, the error suggests the nearest one.
CLI::Validator one_of_words(std::vector<std::string> words);

/// Accepts any text except an empty one, such as that of an unset shell variable.
CLI::Validator not_empty();

/// Replaces a shipped name with its file (using find_shipped, or find_scene for scenes); leaves an
/// empty word unchanged.
void resolve(std::string& word, Shipped what);

/// Checks, before any work is done, that the file can be written, and that an existing file is of
/// the kind that its extension implies. Creates the file's folder.
/// @param read  what the command reads; none of it may be overwritten
/// @throws InputError naming file or folder; DiskFullError.
void require_writable(const std::filesystem::path& file,
                      const std::vector<std::filesystem::path>& read = {});

/// Like require_writable(), for a file that may be replaced only if this command wrote it.
/// @param is_ours  whether a text was written by this command; an empty file may be replaced
/// @param head     what every file written by this command begins with
/// @param kind     the command that writes such files: "`modelhouse map plan`"
void require_replaceable(const std::filesystem::path& file, std::string_view head,
                         std::string_view kind, const std::vector<std::filesystem::path>& read);
void require_replaceable(const std::filesystem::path& file,
                         const std::function<bool(const std::string&)>& is_ours,
                         std::string_view kind, const std::vector<std::filesystem::path>& read);

/// Checks, before anything is written, that the output file is none of the files that were read;
/// for a scene, these include every file that it was loaded from.
/// @throws InputError naming the file.
void require_not_read(const std::filesystem::path& file, const ReadRecord& record);

/// Remembers which folders of a path do not exist yet; at the end, removes those that are empty.
class NewFolders {
 public:
  explicit NewFolders(std::filesystem::path folder);
  ~NewFolders();
  NewFolders(const NewFolders&) = delete;
  NewFolders& operator=(const NewFolders&) = delete;

 private:
  std::vector<std::filesystem::path> missing_;  // innermost first
};

/// A command's output folder. It is created before any work is done, so that an unwritable folder
/// fails at once. If the command fails before it has written anything, no empty folder is left
/// behind. A file in the folder, `.modelhouse`, names the commands that wrote there; these commands
/// may replace their own files.
class OutputFolder {
 public:
  /// Whether other processes may work there at the same time: never, or if they join the folder's
  /// hold() for the same work.
  enum class Others { kNone, kMayJoin };
  /// @param command  "drive", as the user calls it
  /// @param names    names of the files that the command will write there
  /// @throws InputError if a file with one of these names exists that the command did not write, or
  /// if a different command is working there; also as make_output_folder()
  OutputFolder(const std::filesystem::path& folder, const std::string& command,
               std::vector<std::string> names, Others others = Others::kNone);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  FolderHold& hold() { return hold_; }

 private:
  bool holds_any() const;

  const std::filesystem::path folder_;
  const std::vector<std::string> names_;
  const NewFolders made_;
  FolderHold hold_;
  std::optional<std::string> mark_before_;  // .modelhouse before this changed it
};

}  // namespace mh::cli
