// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "slam/core/temporary_folder.hpp"

namespace mh {

// A results file as an SQLite database that holds what it must.
// @throws InputError if it is damaged, of another schema or no results file.

/// Opens or creates the file.
std::unique_ptr<SQLite::Database> open_to_write(const std::filesystem::path& file);

/// A file that was opened to be read.
struct UnchangedFile {
  std::string name;  ///< what SQLite opened: the file, a copy, or a name that says how
  std::unique_ptr<TemporaryFolder> copy;
  std::unique_ptr<SQLite::Database> database;  ///< closed before its copy goes
};

/// Opens a file without changing it; it may lie where nothing can be written. Looks at every row.
UnchangedFile open_unchanged(const std::filesystem::path& file);

/// A transaction that is begun for writing at once, so that it never has to be given up later.
SQLite::Transaction begin_writing(SQLite::Database& db);

}  // namespace mh
