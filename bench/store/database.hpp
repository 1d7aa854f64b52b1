// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "slam/io/temporary_folder.hpp"

namespace mh {

// A results file as an SQLite database whose content has been checked.
// @throws InputError if it is damaged, has a different schema or is not a results file.

/// Opens or creates the file.
std::unique_ptr<SQLite::Database> open_to_write(const std::filesystem::path& file);

/// A file opened for reading only.
struct UnchangedFile {
  std::string name;  ///< what SQLite opened: the file, a copy, or a URI with options
  std::unique_ptr<TemporaryFolder> copy;
  std::unique_ptr<SQLite::Database> database;  ///< closed before its copy is removed
};

/// Opens a file without changing it; it may be in a read-only place. Checks every row.
UnchangedFile open_unchanged(const std::filesystem::path& file);

/// Checks only the file's pages, as SQLite does; require_whole_table() checks rows.
void require_whole_pages(SQLite::Database& db, const std::filesystem::path& file);

/// Begins a transaction that locks for writing immediately, so that it never has to be abandoned
/// later.
SQLite::Transaction begin_writing(SQLite::Database& db);

}  // namespace mh
