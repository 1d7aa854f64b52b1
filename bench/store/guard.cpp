// SPDX-License-Identifier: Apache-2.0
#include "bench/store/guard.hpp"

#include <sqlite3.h>

#include <fmt/format.h>

#include "slam/io/file_errors.hpp"

namespace mh {

void throw_meaning(const std::filesystem::path& file, const SQLite::Exception& error) {
  const std::string name = file.string();
  switch (error.getErrorCode()) {
    case SQLITE_FULL:
      throw DiskFullError(fmt::format(
          "{}: the disk is full: make room and run again, what is finished is kept", name));
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      throw InputError(fmt::format(
          "{}: is damaged or not a results file: put back a copy, or move it away and run again",
          name));
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw MachineError(fmt::format(
          "{}: another process holds a lock on it: wait or end it, then run again", name));
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_READONLY:
      throw InputError(
          fmt::format("{}: cannot be opened for writing: check folder and permissions", name));
    case SQLITE_IOERR:
      throw MachineError(
          fmt::format("{}: its disk cannot be read or written: fix it and run again, what is "
                      "finished is kept",
                      name));
    case SQLITE_NOMEM:
      throw MachineError(fmt::format("{}: out of memory", name));
    case SQLITE_ERROR:
    case SQLITE_SCHEMA:
    case SQLITE_MISMATCH:
    case SQLITE_CONSTRAINT:
      throw InputError(fmt::format(
          "{}: does not hold what a results file must: put back a copy, or move it away and run "
          "again",
          name));
    default:
      throw MachineError(
          fmt::format("{}: SQLite gave up (code {}): run again, what is finished is kept", name,
                      error.getErrorCode()));
  }
}

}  // namespace mh
