// SPDX-License-Identifier: Apache-2.0
#include "bench/store/database.hpp"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include <fmt/format.h>

#include "bench/store/row_digest.hpp"
#include "bench/store/schema.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr int kBusy_ms = 60000;

std::unique_ptr<SQLite::Database> open(const std::string& name, int flags) {
  auto database = std::make_unique<SQLite::Database>(
      name, SQLite::OPEN_READWRITE | SQLite::OPEN_URI | flags, kBusy_ms);
  add_row_digest(*database);
  return database;
}

/// Switches to WAL mode. Tries repeatedly: if two processes open a new file at the same time, the
/// switch of one fails at once instead of waiting for the other.
void enter_wal(SQLite::Database& db) {
  constexpr int kTries = 200;
  for (int tries = 1;; ++tries) {
    try {
      if (db.execAndGet("PRAGMA journal_mode").getString() != "wal")
        db.exec("PRAGMA journal_mode = WAL");
      return;
    } catch (const SQLite::Exception& error) {
      if (error.getErrorCode() != SQLITE_BUSY || tries == kTries) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
}

/// Checks the columns of each table. Merging copies whole rows, so an extra or missing column would
/// be an error, and a column of a different type would change numbers. Additional tables are
/// harmless.
void require_schema(SQLite::Database& db, const fs::path& file) {
  SQLite::Database fresh(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  fresh.exec(schema());
  auto found = schema_texts(db);
  for (const auto& [table, expected] : schema_texts(fresh))
    if (found[table] != expected)
      throw InputError(fmt::format(
          "{}: does not hold what a results file must (the columns of the table '{}'): put back a "
          "copy, or move it away and run again",
          file.string(), table));
}

int version_of(SQLite::Database& db) {
  return db.execAndGet("PRAGMA user_version").getInt();
}

/// @throws InputError unless the file has this program's schema.
void require_version(SQLite::Database& db, const fs::path& file) {
  const int version = version_of(db);
  if (version == kSchemaVersion) return;
  if (version == 0)
    throw InputError(fmt::format("{}: is a database, but not a results file", file.string()));
  throw InputError(
      version > kSchemaVersion
          ? fmt::format("{}: has schema {}, this version of modelhouse reads {}: use a newer one",
                        file.string(), version, kSchemaVersion)
          : fmt::format("{}: has schema {} of an older modelhouse, this one reads {}: move it away "
                        "and run again",
                        file.string(), version, kSchemaVersion));
}

/// Whether SQLite may write the file and its log next to it.
bool may_be_written(const fs::path& file) {
  const fs::path folder = fs::absolute(file).parent_path();
  return faccessat(AT_FDCWD, file.c_str(), W_OK, AT_EACCESS) == 0 &&
         faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) == 0;
}

fs::path log_of(const fs::path& file) {
  return file.string() + "-wal";
}

/// URI by which SQLite opens a file that no process is writing, without a lock or a log.
std::string as_immutable(const fs::path& file) {
  std::string name = "file:";
  for (const char c : fs::absolute(file).string())
    name += std::string_view("%?#").find(c) == std::string_view::npos
                ? std::string(1, c)
                : fmt::format("%{:02X}", static_cast<unsigned>(c));
  return name + "?immutable=1";
}

}  // namespace

void require_whole_pages(SQLite::Database& db, const fs::path& file) {
  if (const std::string found = db.execAndGet("PRAGMA quick_check(1)").getString(); found != "ok")
    throw InputError(
        fmt::format("{}: is damaged ({}): put back a copy, or move it away and run again",
                    file.string(), found));
}

std::unique_ptr<SQLite::Database> open_to_write(const fs::path& file) {
  auto database = open(fs::absolute(file).string(), SQLite::OPEN_CREATE);
  SQLite::Database& db = *database;
  if (version_of(db) > kSchemaVersion) require_version(db, file);
  enter_wal(db);
  db.exec("PRAGMA synchronous = FULL");
  if (version_of(db) == 0) {
    SQLite::Transaction transaction = begin_writing(db);
    if (version_of(db) == 0 &&  // no other process was first
        db.execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0) {
      db.exec(schema());
      db.exec(fmt::format("PRAGMA user_version = {}", kSchemaVersion));
    }
    transaction.commit();
  }
  require_whole_pages(db, file);
  require_version(db, file);
  require_schema(db, file);
  return database;
}

UnchangedFile open_unchanged(const fs::path& file) {
  UnchangedFile opened;
  std::error_code error;
  if (may_be_written(file)) {
    opened.name = fs::absolute(file).string();
  } else if (const auto left = fs::file_size(log_of(file), error); error || left == 0) {
    opened.name = as_immutable(file);
  } else {  // the log must be applied, so both are copied
    opened.copy = std::make_unique<TemporaryFolder>(fs::temp_directory_path());
    const fs::path copy = opened.copy->path() / "results.sqlite";
    write_atomically(copy, read_file(file));
    write_atomically(log_of(copy), read_file(log_of(file)));
    opened.name = copy.string();
  }
  opened.database = open(opened.name, 0);
  require_whole_pages(*opened.database, file);
  require_version(*opened.database, file);
  require_schema(*opened.database, file);
  require_whole_rows(*opened.database, file);
  return opened;
}

SQLite::Transaction begin_writing(SQLite::Database& db) {
  return SQLite::Transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
}

}  // namespace mh
