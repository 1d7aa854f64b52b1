// SPDX-License-Identifier: Apache-2.0
#include "bench/report/text_table.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace mh {

TextTable::TextTable(std::vector<std::string> headings, std::size_t left) : left_(left) {
  add(std::move(headings));
}

void TextTable::add(std::vector<std::string> cells, std::string remark) {
  lines_.push_back({std::move(cells), remark.empty() ? "" : "   " + remark});
}

void TextTable::add_line(std::string text) {
  lines_.push_back({{}, std::move(text)});
}

std::string TextTable::text() const {
  std::vector<std::size_t> widths(lines_.front().cells.size());
  for (const Line& line : lines_)
    for (std::size_t c = 0; c < line.cells.size(); ++c)
      widths[c] = std::max(widths[c], line.cells[c].size());
  std::string text;
  for (const Line& line : lines_) {
    std::string row;
    for (std::size_t c = 0; c < line.cells.size(); ++c)
      row += c < left_ ? fmt::format("  {:<{}}", line.cells[c], widths[c])
                       : fmt::format("  {:>{}}", line.cells[c], widths[c]);
    row += line.cells.empty() ? "  " + line.rest : line.rest;
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace mh
