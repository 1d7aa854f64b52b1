// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/label_table.hpp"

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <vector>

#include <fmt/format.h>

#include "scenes/mesh_io/node_name.hpp"
#include "slam/io/error.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

constexpr ClassId kLastNyu40 = 40;

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t tab = line.find('\t');
    cells.push_back(line.substr(0, tab));
    if (tab == line.npos) return cells;
    line.remove_prefix(tab + 1);
  }
}

/// Lines without their ends, \n or \r\n.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
  }
  return lines;
}

class TableParser {
 public:
  explicit TableParser(const std::string& name) { table_.file = name; }

  LabelTable parse(std::string_view text) {
    const auto lines = lines_of(text);
    if (lines.empty()) fail(1, "is empty");
    read_header(cells_of(lines[0]));
    for (std::size_t i = 1; i < lines.size(); ++i) {
      if (lines[i].empty()) continue;
      const auto cells = cells_of(lines[i]);
      // Columns after the classes may be missing; but a file that ends within the row is truncated.
      const bool ends_file = i + 1 == lines.size() && !text.ends_with('\n');
      const std::size_t needed = ends_file ? columns_ : needed_;
      if (cells.size() < needed)
        fail(i + 1, fmt::format("is truncated: the row has {} cells, the header has {}",
                                cells.size(), columns_));
      read_row(cells, i + 1);
    }
    if (table_.class_of_category.empty()) fail(1, "has no row");
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", table_.file, line, what));
  }

  void read_header(const std::vector<std::string_view>& names) {
    const auto column = [&](std::initializer_list<std::string_view> wanted) {
      for (const std::string_view name : wanted)
        if (const auto at = std::ranges::find(names, name); at != names.end())
          return static_cast<std::size_t>(at - names.begin());
      return kNone;
    };
    table_.release = column({"raw_category"}) == kNone ? ScannetRelease::kV1 : ScannetRelease::kV2;
    category_ = column({"raw_category", "category"});
    id_ = column({"id", "index"});
    nyu40_id_ = column({"nyu40id"});
    nyu40_class_ = column({"nyu40class"});
    own_ = column({"modelhouse"});
    if (category_ == kNone) fail(1, "has neither a column 'raw_category' (v2) nor 'category' (v1)");
    if (nyu40_id_ == kNone && nyu40_class_ == kNone)
      fail(1, "has neither a column 'nyu40id' nor 'nyu40class'");
    columns_ = names.size();
    needed_ = std::min(nyu40_id_, nyu40_class_) + 1;
  }

  void read_row(const std::vector<std::string_view>& cells, std::size_t line) {
    const auto cell = [&](std::size_t column) {
      return column < cells.size() ? cells[column] : std::string_view();
    };
    const std::string_view category = cell(category_);
    if (category.empty()) fail(line, "the category is empty");
    ++rows_;
    const auto id =
        id_ == kNone ? std::optional(rows_) : number(cell(id_), line, "raw category id");
    if (!id) fail(line, "the raw category id is missing");
    ClassId class_id = class_of(cell(own_), cell(nyu40_id_), cell(nyu40_class_), line);
    // A category typed by annotators may name a class that NYU40 merges with others.
    if (const auto named = class_of_noun(category); named && is_finer(*named, class_id))
      class_id = *named;
    table_.class_of_category.emplace(category, class_id);
    table_.class_of_id.emplace(*id, class_id);
  }

  /// Nullopt for an empty cell.
  std::optional<std::uint32_t> number(std::string_view text, std::size_t line,
                                      const char* what) const {
    if (text.empty()) return std::nullopt;
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      fail(line, fmt::format("'{}' is not a valid {}", text.substr(0, 40), what));
    return value;
  }

  ClassId class_of(std::string_view own, std::string_view nyu40_id, std::string_view nyu40_class,
                   std::size_t line) const {
    const auto id = number(nyu40_id, line, "NYU40 id");
    if (id && *id > kLastNyu40) fail(line, fmt::format("{} is not an NYU40 id", *id));
    if (!own.empty()) {
      const auto found = class_by_name(own);
      if (!found) fail(line, fmt::format("'{}' is not a class", own.substr(0, 40)));
      return *found;
    }
    if (id) return static_cast<ClassId>(*id);
    return class_by_name(nyu40_class).value_or(kVoid);
  }

  static constexpr std::size_t kNone = ~std::size_t{0};
  LabelTable table_;
  std::uint32_t rows_ = 0;
  std::size_t columns_ = 0, needed_ = 0;  ///< columns in all; columns up to a class column
  std::size_t category_ = kNone, id_ = kNone, nyu40_id_ = kNone, nyu40_class_ = kNone, own_ = kNone;
};

}  // namespace

LabelTable parse_label_table(std::string_view text, const std::string& name) {
  return TableParser(name).parse(text);
}

LabelTable load_label_table(const std::filesystem::path& file) {
  return parse_label_table(read_text(file), file.string());
}

std::string label_table_text() {
  // ScanNet's columns in ScanNet's order; unknown ones are empty.
  std::string text =
      "id\traw_category\tcategory\tcount\tnyu40id\teigen13id\tnyuClass\tnyu40class\teigen13class\t"
      "ModelNet40\tModelNet10\tShapeNetCore55\tsynsetoffset\twnsynsetid\twnsynsetkey\tmpcat40\t"
      "mpcat40index\tmodelhouse\n";
  for (const ClassInfo& info : classes()) {
    if (info.id == kVoid || info.id == kBackground) continue;
    text += fmt::format("{0}\t{1}\t{1}\t0\t{2}\t\t{1}\t{3}\t\t\t\t\t\t\t\t\t\t{1}\n", info.id,
                        info.name, info.nyu40, classes()[info.nyu40].name);
  }
  return text;
}

}  // namespace mh
