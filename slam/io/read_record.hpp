// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "slam/io/error.hpp"

namespace mh {

/// What the file system reports about a file. It changes whenever the file is written, replaced,
/// renamed or touched, and no program can set it back.
struct FileState {
  std::uint64_t device = 0, inode = 0, bytes = 0;  ///< inode 0: there is no such file
  std::int64_t changed_ns = 0;
  friend bool operator==(const FileState&, const FileState&) = default;
};
FileState state_of(const std::filesystem::path& file);

/// One answer from the file system that a load depended on.
struct FileObservation {
  enum class Kind : std::uint8_t {
    kAbsent,  ///< looked for and missing, or present but unreadable
    kFile,    ///< looked for and found
    kFolder,  ///< looked for and found
    kOther,   ///< looked for and found, but neither file nor folder: a pipe, a device
    kListed,  ///< the names in a folder that match a pattern; path = folder / pattern
    kRead,    ///< the whole content of a file
    kHeld,  ///< a file that may be read again later, or is missing and may be looked for again; not
            ///< part of digests
  };
  Kind kind = Kind::kAbsent;
  std::filesystem::path path;  ///< as it was spelled by the caller
  std::uint64_t digest = 0;    ///< xxh3-64 of the names (kListed) or the content (kRead), else 0
  FileState state = {};  ///< from before the file was read (kRead, kHeld), or from when it was
                         ///< looked for (kAbsent)
  friend bool operator==(const FileObservation& a, const FileObservation& b) {
    return a.kind == b.kind && a.path == b.path && a.digest == b.digest;
  }
};

/// Everything that a load observed in the file system, in the order of its requests. A loader
/// chooses its next request based on the answers so far, so equal answers in the same order imply
/// the same load, and file locations need not be part of the record.
struct ReadRecord {
  std::vector<FileObservation> observations;
  void append(const ReadRecord& more);
  friend bool operator==(const ReadRecord&, const ReadRecord&) = default;
};

/// xxh3-64 of a record: kinds, contents and, for files, the last component of their names. The same
/// folder elsewhere has the same digest.
std::uint64_t digest(const ReadRecord& record);

/// Whether the observation contains the state of its file: read, held or absent.
bool is_of_a_state(const FileObservation& observation);

/// A file was changed while a command worked with it: results would mix its old and new states.
struct InputChanged : InputError {
  using InputError::InputError;
};

/// Checks that no file was changed since it was read, or appeared since it was found missing, so
/// that what was made from several files, or from one read several times, is consistent.
/// @throws InputChanged naming the first such file.
void require_unchanged(const ReadRecord& record);

/// Serializes a record, to pass it from one process to another, and back.
/// @throws InputError if the bytes are not a record.
std::string encode(const ReadRecord& record);
ReadRecord decode_read_record(std::string_view bytes);

/// While in scope, records everything that this thread reads or looks for through
/// slam/io/files.hpp, map_file() or YamlReader. Scopes nest: the outer one also records what the
/// inner one does.
class ReadScope {
 public:
  /// Whether the enclosing scope also records what this one does.
  enum class Outer { kRecords, kIgnores };
  explicit ReadScope(Outer outer = Outer::kRecords);
  ~ReadScope();
  ReadScope(const ReadScope&) = delete;
  ReadScope& operator=(const ReadScope&) = delete;

  const ReadRecord& record() const { return record_; }

  /// Whether any scope is open on this thread.
  static bool is_open() { return innermost_ != nullptr; }
  /// Reports an observation to the scopes of this thread: for readers that open files by other
  /// means, or for what another process read.
  static void report(const FileObservation& observation);
  static void report(const ReadRecord& record);

 private:
  static thread_local ReadScope* innermost_;
  ReadRecord record_;
  ReadScope* const outer_;
  const bool tells_outer_;
};

/// Reports to the scopes of this thread that a file was read; costs nothing if there are none.
/// @param before  state of the file before it was read
void report_read(const std::filesystem::path& file, std::string_view content,
                 const FileState& before);
/// Reports that a file was looked for and is missing, or cannot be read.
void report_absent(const std::filesystem::path& file);

}  // namespace mh
