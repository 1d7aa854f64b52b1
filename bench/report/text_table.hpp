// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// How much of the results a text contains: everything, or only what fits on a screen.
enum class Extent { kWhole, kScreen };

/// Rows of cells under headings, for a terminal. Each column is as wide as its widest cell, columns
/// are separated by two spaces, and every line starts with two.
class TextTable {
 public:
  /// @param left  how many columns, from the first, are left-aligned; the others are right-aligned
  explicit TextTable(std::vector<std::string> headings, std::size_t left = 1);

  /// @param remark  printed at the end of the row, to the right of all columns
  void add(std::vector<std::string> cells, std::string remark = {});
  /// Adds a line of text between rows.
  void add_line(std::string text);

  std::string text() const;

 private:
  struct Line {
    std::vector<std::string> cells;
    std::string rest;
  };
  std::size_t left_;
  std::vector<Line> lines_;
};

/// A cell of a CSV file, in quotes if it needs them.
std::string csv_cell(const std::string& text);

}  // namespace mh
