// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/protocol/metrics/metric.hpp"

namespace mh {

/// How a column of a table is titled and printed.
struct PageColumn {
  std::string key;         ///< by which pages find the column: "held_out.success"
  std::string title;       ///< what a reader sees
  std::string unit{};      ///< "m"; "%": a share, stored as 0 to 1 and printed times 100
  int decimals = 0;        ///< digits after the decimal point
  bool is_hidden = false;  ///< for charts only
};

/// The column that shows a metric.
PageColumn column_of(const Metric& metric, std::string title = {});

/// A table stored by columns, as pages read it: each word is stored once and then referred to by
/// number, unknown values are null, and numbers have seven significant digits. A column exists as
/// soon as one row has a cell in it; it is null in the rows without a cell.
class PageTable {
 public:
  explicit PageTable(std::string title, std::string note = {})
      : title_(std::move(title)), note_(std::move(note)) {}

  void begin_row() { ++rows_; }
  void text(const PageColumn& column, std::string_view value);
  void number(const PageColumn& column, const std::optional<double>& value);
  /// Adds all figures of a score; `prefix` goes before their keys and titles.
  void figures(const std::vector<Figure>& figures, const std::string& prefix = {},
               const std::string& title_prefix = {});

  std::size_t rows() const { return rows_; }
  nlohmann::ordered_json json() const;

 private:
  struct Column {
    PageColumn about;
    bool is_text = false;
    std::vector<std::string> words = {};
    std::map<std::string, std::size_t, std::less<>> index_of = {};
    std::vector<std::optional<std::size_t>> word_of = {};  // by row
    std::vector<std::optional<double>> numbers = {};       // by row
  };
  Column& column(const PageColumn& about, bool is_text);

  std::string title_, note_;
  std::size_t rows_ = 0;
  std::vector<Column> columns_;
  std::map<std::string, std::size_t> place_of_;
};

/// A number for pages: seven significant digits; null if unknown or not finite.
nlohmann::ordered_json page_number(const std::optional<double>& value);

/// JSON that a script file may hold: `<` and `&` are written as escapes, so that no text from data
/// can end a script or begin a tag; invalid UTF-8 is replaced.
std::string script_json(const nlohmann::ordered_json& json);

/// The text of a script file that adds a piece of data to the registry under its name.
std::string script_of(const std::string& piece, const nlohmann::ordered_json& json);
/// Whether a file is such a script.
bool is_script_of_data(std::string_view content);

}  // namespace mh
