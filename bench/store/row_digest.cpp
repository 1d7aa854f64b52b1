// SPDX-License-Identifier: Apache-2.0
#include "bench/store/row_digest.hpp"

#include <sqlite3.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "slam/core/digest.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

template <class T>
void append(std::string& bytes, char tag, T value) {
  bytes += tag;
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append(std::string& bytes, sqlite3_value* value) {
  constexpr double kExact = 9e15;  // integers up to this are exact
  switch (sqlite3_value_type(value)) {
    case SQLITE_INTEGER:
      return append(bytes, 'n', static_cast<std::int64_t>(sqlite3_value_int64(value)));
    case SQLITE_FLOAT: {
      // An integer column stores 12.0 as 12, a real column 12 as 12.0: both get the same digest.
      const double number = sqlite3_value_double(value);
      if (std::abs(number) < kExact && number == std::floor(number))
        return append(bytes, 'n', static_cast<std::int64_t>(number));
      return append(bytes, 'r', number);
    }
    case SQLITE_NULL:
      bytes += '0';
      return;
    default: {
      const bool text = sqlite3_value_type(value) == SQLITE_TEXT;
      const auto* content =
          text ? static_cast<const void*>(sqlite3_value_text(value)) : sqlite3_value_blob(value);
      const int size = sqlite3_value_bytes(value);
      append(bytes, text ? 't' : 'b', size);
      if (content != nullptr)
        bytes.append(static_cast<const char*>(content), static_cast<std::size_t>(size));
    }
  }
}

void row_digest(sqlite3_context* context, int count, sqlite3_value** values) {
  std::string bytes;
  for (int i = 0; i < count; ++i) append(bytes, values[i]);
  sqlite3_result_int64(context,
                       static_cast<sqlite3_int64>(digest_bytes(bytes.data(), bytes.size())));
}

struct Columns {
  std::string values;  ///< "'plan', position, name, key": the arguments of row_digest()
  std::string key;     ///< "position || ', ' || name": the name of a row
  std::string digest;  ///< name of the last column
};

Columns columns_of(SQLite::Database& db, const std::string& table) {
  Columns columns{fmt::format("'{}'", table), "", ""};
  SQLite::Statement s(db, "SELECT name, pk FROM pragma_table_info(?) ORDER BY cid");
  s.bind(1, table);
  while (s.executeStep()) {
    if (!columns.digest.empty()) columns.values += ", " + columns.digest;
    columns.digest = fmt::format("\"{}\"", s.getColumn(0).getString());
    if (s.getColumn(1).getInt() > 0)
      columns.key += (columns.key.empty() ? "" : " || ', ' || ") + columns.digest;
  }
  return columns;
}

/// Makes text printable for a message: a damaged row may contain any bytes.
std::string ascii(std::string text) {
  constexpr std::size_t kMost = 120;
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  return text.size() > kMost ? text.substr(0, kMost) + "..." : text;
}

/// Checks that no row was lost.
void require_all_rows(SQLite::Database& db, const std::filesystem::path& file) {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format(
        "{}: is damaged: {}: put back a copy, or move it away and run again", file.string(), what));
  };
  std::string of_run, of_all;
  for (const char* table : kTablesOfRuns) {
    const char* plus = of_run.empty() ? "" : " + ";
    of_run += fmt::format("{0}(SELECT count(*) FROM {1} WHERE {1}.key = runs.key)", plus, table);
    of_all += fmt::format("{}(SELECT count(*) FROM {})", plus, table);
  }
  SQLite::Statement lost(
      db, fmt::format("SELECT name, row_count, {0} AS found FROM runs WHERE row_count <> found "
                      "ORDER BY name LIMIT 1",
                      of_run));
  if (lost.executeStep())
    fail(fmt::format("run '{}' has {} of {} rows", ascii(lost.getColumn(0).getString()),
                     lost.getColumn(2).getInt64(), lost.getColumn(1).getInt64()));
  // All in one statement, since other processes may be adding results.
  SQLite::Statement left(
      db, fmt::format("SELECT {} - (SELECT coalesce(sum(row_count), 0) FROM runs)", of_all));
  left.executeStep();
  if (left.getColumn(0).getInt64() != 0)
    fail(fmt::format("{} belong to a run that its table 'runs' has lost",
                     counted(static_cast<std::size_t>(left.getColumn(0).getInt64()), "row")));
  SQLite::Statement plan(db,
                         "SELECT run_count, (SELECT count(*) FROM plan) AS found FROM suite "
                         "WHERE run_count <> found");
  if (plan.executeStep())
    fail(fmt::format("its table 'plan' has {} of {} rows", plan.getColumn(1).getInt64(),
                     plan.getColumn(0).getInt64()));
}

}  // namespace

void add_row_digest(SQLite::Database& db) {
  db.createFunction("row_digest", -1, true, nullptr, row_digest, nullptr, nullptr, nullptr);
}

int column_count(SQLite::Database& db, const std::string& table) {
  return db.execAndGet(fmt::format("SELECT count(*) FROM pragma_table_info('{}')", table))
             .getInt() -
         1;
}

std::string insert_row(const std::string& table, int values, const char* verb) {
  std::string marks = "?1";
  for (int i = 2; i <= values; ++i) marks += fmt::format(", ?{}", i);
  return fmt::format("{0} INTO {1} VALUES ({2}, row_digest('{1}', {2}))", verb, table, marks);
}

void require_whole_table(SQLite::Database& db, const std::filesystem::path& file,
                         const std::string& table) {
  const Columns columns = columns_of(db, table);
  SQLite::Statement s(db, fmt::format("SELECT {} FROM {} WHERE {} IS NOT row_digest({}) LIMIT 1",
                                      columns.key, table, columns.digest, columns.values));
  if (s.executeStep())
    throw InputError(fmt::format(
        "{}: is damaged: row ({}) of its table '{}': put back a copy, or move it away and run "
        "again",
        file.string(), ascii(s.getColumn(0).getString()), table));
}

void require_whole_rows(SQLite::Database& db, const std::filesystem::path& file) {
  for (const char* table : kDigestedTables) require_whole_table(db, file, table);
  require_all_rows(db, file);
}

std::map<std::string, std::string> schema_texts(SQLite::Database& db) {
  std::map<std::string, std::string> texts;
  SQLite::Statement s(db, "SELECT name, sql FROM sqlite_master WHERE type = 'table'");
  while (s.executeStep()) texts[s.getColumn(0).getString()] = s.getColumn(1).getString();
  return texts;
}

}  // namespace mh
