// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

namespace mh {

// Each row of a results file, except in `claims`, has as its last column a digest of its table's
// name and its other values: SQLite has no checksums, and a number with a flipped bit is still a
// number. `runs` also stores how many rows each run has in the other tables, and `suite` how many
// `plan` has, because a lost row leaves no digest to check.

/// The tables whose rows have a digest, in the order of the schema.
inline constexpr const char* kDigestedTables[] = {"suite",    "plan",  "runs",   "points",
                                                  "metrics",  "calls", "frames", "queries",
                                                  "episodes", "times"};

/// The tables whose rows `runs.row_count` counts.
inline constexpr const char* kTablesOfRuns[] = {"points",  "metrics",  "calls", "frames",
                                                "queries", "episodes", "times"};

/// Registers the SQL function row_digest(table, value, ...) with a connection; it returns a 64-bit
/// integer. A number's digest is that of its value: 3 and 3.0 have the same digest.
void add_row_digest(SQLite::Database& db);

/// How many columns a table has, without the digest.
int column_count(SQLite::Database& db, const std::string& table);

/// "INSERT INTO plan VALUES (?1, ?2, ?3, row_digest('plan', ?1, ?2, ?3))" for three values.
std::string insert_row(const std::string& table, int values, const char* verb = "INSERT");

/// Checks every row of a table whose last column is a row digest. @throws InputError naming file,
/// table and the first row whose digest does not match its values.
void require_whole_table(SQLite::Database& db, const std::filesystem::path& file,
                         const std::string& table);

/// Checks every row, and that none is missing. @throws InputError naming file, table and the first
/// row whose digest does not match its values, or the first run that has lost rows.
void require_whole_rows(SQLite::Database& db, const std::filesystem::path& file);

/// The text that created each table of a database, by the table's name.
std::map<std::string, std::string> schema_texts(SQLite::Database& db);

}  // namespace mh
