// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include "bench/store/row_digest.hpp"
#include "bench/suite/json_fields.hpp"
#include "slam/io/json_text.hpp"
#include "slam/io/settings_io.hpp"

// Records as rows of SQL tables, via their lists of fields: the column definitions, and values in
// both directions. Nested records are flattened into columns; a pose takes seven columns; a list is
// stored as JSON text; values that are unknown or not finite are stored as null.

namespace mh {

inline constexpr const char* kPoseColumns[] = {"tx", "ty", "tz", "qx", "qy", "qz", "qw"};

/// Whether one column can store a value of this type.
template <class T>
inline constexpr bool kIsColumn = std::is_arithmetic_v<T> || std::is_enum_v<T> || kIsDigest<T> ||
                                  kIsArray<T> || kIsVector<T> || std::is_same_v<T, std::string>;

/// Collects "name TYPE NOT NULL, ..." for CREATE TABLE.
class ColumnTexts {
 public:
  template <class T>
  void operator()(const char* name, const T&) {
    add<T>(name, " NOT NULL");
  }
  /// The column of a setting: null if the system does not have that setting.
  template <class T>
  void operator()(const char* name, const T&, const SettingRange&, const char*) {
    text_ += fmt::format("  {} {},\n", name,
                         std::is_floating_point_v<T> ? "REAL"
                         : std::is_integral_v<T>     ? "INTEGER"
                                                     : "TEXT");
  }
  const std::string& text() const { return text_; }

 private:
  template <class T>
  void add(const char* name, const char* constraint) {
    if constexpr (kIsOptional<T>) {
      add<typename T::value_type>(name, "");
    } else if constexpr (std::is_same_v<T, SE3>) {
      for (const char* part : kPoseColumns) text_ += fmt::format("  {}_{} REAL,\n", name, part);
    } else if constexpr (kIsColumn<T>) {
      // A number that is not finite is null.
      text_ += std::is_floating_point_v<T>
                   ? fmt::format("  {} REAL,\n", name)
                   : fmt::format("  {} {}{},\n", name, std::is_integral_v<T> ? "INTEGER" : "TEXT",
                                 constraint);
    } else {
      const T record{};
      fields(record, *this);
    }
  }

  std::string text_;
};

/// The columns of a record, each line ending in a comma.
template <class Record>
std::string columns_of() {
  ColumnTexts texts;
  const Record record{};
  fields(record, texts);
  return texts.text();
}

/// Inserts rows into a table, value by value in column order.
class RowWriter {
 public:
  /// A row has a value for every column of the table except the digest, which SQL computes.
  RowWriter(SQLite::Database& db, const std::string& table)
      : statement_(db, insert_row(table, column_count(db, table))) {}

  template <class T>
  RowWriter& operator<<(const T& value) {
    put(value);
    return *this;
  }
  template <class T>
  void operator()(const char*, const T& value) {
    put(value);
  }
  template <class T>
  void operator()(const char*, const T& value, const SettingRange&, const char*) {
    if constexpr (std::is_enum_v<T>)
      put(SettingsWriter::word_of(value));
    else
      put(value);
  }
  void end_row() {
    statement_.exec();
    statement_.reset();
    statement_.clearBindings();
    next_ = 1;
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (kIsOptional<T>) {
      if (value)
        put(*value);
      else
        next_ += std::is_same_v<T, std::optional<SE3>> ? 7 : 1;  // these columns are left null
    } else if constexpr (std::is_same_v<T, double>) {
      if (std::isfinite(value)) statement_.bind(next_, value);
      ++next_;
    } else if constexpr (std::is_integral_v<T>) {
      statement_.bind(next_++, static_cast<std::int64_t>(value));
    } else if constexpr (std::is_convertible_v<T, std::string_view>) {
      statement_.bind(next_++, std::string(std::string_view(value)));
    } else if constexpr (std::is_same_v<T, SE3>) {
      for (const auto& number : json_of(value)) put(number.template get<double>());
    } else if constexpr (kIsArray<T> || kIsVector<T>) {
      put(json_of(value).dump());
    } else if constexpr (kIsColumn<T>) {
      put(json_of(value).template get<std::string>());
    } else {
      fields(value, *this);
    }
  }

  SQLite::Statement statement_;
  int next_ = 1;
};

/// Reads the values of a row, one column after another.
class RowReader {
 public:
  explicit RowReader(SQLite::Statement& row, int first = 0) : row_(row), next_(first) {}

  template <class T>
  void operator()(const char*, T&& value) {
    take(value);
  }

 private:
  template <class T>
  void take(T& value) {
    using Value = std::decay_t<T>;
    if constexpr (kIsOptional<Value>) {
      value.reset();
      if (!row_.getColumn(next_).isNull())
        take(value.emplace());
      else
        next_ += std::is_same_v<Value, std::optional<SE3>> ? 7 : 1;
    } else if constexpr (std::is_same_v<Value, double>) {
      const SQLite::Column column = row_.getColumn(next_++);
      value = column.isNull() ? std::numeric_limits<double>::quiet_NaN() : column.getDouble();
    } else if constexpr (std::is_integral_v<Value>) {
      value = static_cast<Value>(row_.getColumn(next_++).getInt64());
    } else if constexpr (std::is_same_v<Value, std::string>) {
      value = row_.getColumn(next_++).getString();
    } else if constexpr (std::is_same_v<Value, SE3>) {
      auto list = nlohmann::ordered_json::array();
      for (int i = 0; i < 7; ++i) list.push_back(row_.getColumn(next_++).getDouble());
      read_json(list, value);
    } else if constexpr (kIsArray<Value> || kIsVector<Value>) {
      read_json(parse_json<nlohmann::ordered_json>(row_.getColumn(next_++).getString()), value);
    } else if constexpr (kIsColumn<Value>) {
      read_json(nlohmann::ordered_json(row_.getColumn(next_++).getString()), value);
    } else {
      fields(value, *this);
    }
  }

  SQLite::Statement& row_;
  int next_;
};

}  // namespace mh
