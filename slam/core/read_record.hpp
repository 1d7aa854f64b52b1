// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// One answer of the file system that what was loaded depends on.
struct FileObservation {
  enum class Kind : std::uint8_t {
    kAbsent,  ///< looked for and not there, or there and not to be read
    kFile,    ///< looked for and there
    kFolder,  ///< likewise
    kOther,   ///< likewise, neither file nor folder: a pipe, a device
    kListed,  ///< the names in a folder that match a pattern; path = folder / pattern
    kRead,    ///< the whole content of a file
  };
  Kind kind = Kind::kAbsent;
  std::filesystem::path path;  ///< as it was named
  std::uint64_t digest = 0;    ///< xxh3-64 of the names (kListed) or the content (kRead), else 0
  friend bool operator==(const FileObservation&, const FileObservation&) = default;
};

/// All that a load saw of the file system, in the order in which it asked. A loader decides what it
/// asks next by the answers so far; hence equal answers in the same order mean the same load, and
/// where the files lie need not be part of it.
struct ReadRecord {
  std::vector<FileObservation> observations;
  void append(const ReadRecord& more);
  friend bool operator==(const ReadRecord&, const ReadRecord&) = default;
};

/// xxh3-64 of a record: kinds, contents and, of files, the last part of their names. The same
/// folder elsewhere has the same digest.
std::uint64_t digest(const ReadRecord& record);

/// A record as bytes, to be handed from one process to another, and back.
/// @throws InputError if the bytes hold no record.
std::string encode(const ReadRecord& record);
ReadRecord decode_read_record(std::string_view bytes);

/// While it lives, everything that this thread reads or looks for through slam/core/files.hpp,
/// map_file() or YamlReader is noted. Scopes nest: the outer one notes what the inner one does.
class ReadScope {
 public:
  /// Whether the scope around this one notes what this one does.
  enum class Outer { kIsTold, kIsNotTold };
  explicit ReadScope(Outer outer = Outer::kIsTold);
  ~ReadScope();
  ReadScope(const ReadScope&) = delete;
  ReadScope& operator=(const ReadScope&) = delete;

  const ReadRecord& record() const { return record_; }

  /// Whether anybody on this thread listens.
  static bool is_open() { return innermost_ != nullptr; }
  /// Tells the scopes of this thread: of a reader that opens files in a way of its own, or of what
  /// another process read.
  static void report(const FileObservation& observation);
  static void report(const ReadRecord& record);

 private:
  static thread_local ReadScope* innermost_;
  ReadRecord record_;
  ReadScope* const outer_;
  const bool tells_outer_;
};

/// Tells the scopes of this thread that a file was read; costs nothing where there are none.
void report_read(const std::filesystem::path& file, std::string_view content);
/// Likewise that it was looked for and is not there, or cannot be read.
void report_absent(const std::filesystem::path& file);

}  // namespace mh
