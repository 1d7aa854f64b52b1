// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "bench/report/drawing/gnuplot.hpp"
#include "bench/report/pages/plot_parts.hpp"
#include "bench/report/pages/tables.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The text of a cell as a reader sees it.
std::string cell_of(const Json& column, std::size_t row) {
  const Json& value = column.at("values").at(row);
  if (value.is_null()) return "";
  if (column.contains("words")) return column.at("words").at(value.get<std::size_t>());
  const bool share = column.value("unit", "") == "%";
  return fmt::format("{:.{}f}", value.get<double>() * (share ? 100 : 1),
                     column.value("decimals", 0));
}

}  // namespace

/// Draws a table: Table 1 with the paper's columns, Table 2 with all columns. Columns without a
/// value are left out. The image is as wide as the table needs.
std::string plot_table(const PagesSource& source, const PlotOrder& order, const fs::path& file) {
  const std::vector<CategoryRow> rows = make_category_rows(
      *source.suite, make_rows(*source.suite, source.results.runs, source.results.failed));
  const Json json =
      order.table == 1 ? table1_json(*source.suite, rows) : table2_json(*source.suite, rows);
  if (json.is_null() || json.at("rows") == 0)
    throw InputError(
        fmt::format("{}: table {} cannot be drawn: {}", source.name, order.table,
                    order.table == 1 ? "the suite has one environment" : "no queries were asked"));
  const auto count = json.at("rows").get<std::size_t>();
  static const std::vector<std::string> kOfTable1 = {"category",
                                                     "system",
                                                     "labels",
                                                     "scenes",
                                                     "ate_rmse_m",
                                                     "rpe_second_rmse_m",
                                                     "held_out.success",
                                                     "held_out.correct",
                                                     "held_out.distance_mean_m",
                                                     "second_tour.success",
                                                     "second_tour.correct",
                                                     "second_tour.distance_mean_m"};
  constexpr double kLetter_cm = 0.142, kGap_cm = 0.45, kLine_cm = 0.42;
  double width_cm = 0.2;
  const double height_cm = kLine_cm * (static_cast<double>(count) + 3.2);
  std::string labels;
  const auto put = [&](const std::string& text, double x_cm, double line, bool left, bool bold) {
    labels += fmt::format("set label {} at {},{} {} noenhanced font '{},8'\n", gnuplot_text(text),
                          x_cm, kLine_cm * line, left ? "left" : "right",
                          bold ? "DejaVu Sans:Bold" : "DejaVu Sans");
  };
  for (const Json& column : json.at("columns")) {
    const std::string key = column.at("key");
    if (order.table == 1 && std::ranges::count(kOfTable1, key) == 0) continue;
    std::vector<std::string> cells;
    for (std::size_t row = 0; row < count; ++row) cells.push_back(cell_of(column, row));
    if (std::ranges::all_of(cells, &std::string::empty)) continue;
    const std::string unit = column.value("unit", "");
    std::string title = column.at("title");
    const std::string last_word = title.substr(title.rfind(' ') + 1);  // "RPE m/s" names its unit
    if (!unit.empty() && last_word != unit && !last_word.starts_with(unit + "/"))
      title += ", " + unit;
    std::size_t longest = title.size() + title.size() / 5;  // bold letters are wider
    for (const std::string& cell : cells) longest = std::max(longest, cell.size());
    const double column_cm = kLetter_cm * static_cast<double>(longest);
    const bool left = column.contains("words");
    const double at_cm = left ? width_cm : width_cm + column_cm;
    put(title, at_cm, 2.0, left, true);
    for (std::size_t row = 0; row < count; ++row)
      put(cells[row], at_cm, 3.2 + static_cast<double>(row), left, false);
    width_cm += column_cm + kGap_cm;
  }
  put(json.at("title"), 0.2, 0.8, true, true);
  return gnuplot_terminal(file, width_cm, height_cm) + labels +
         fmt::format(
             "unset border\nunset tics\nunset key\nset margins 0,0,0,0\nset xrange [0:{0}]\n"
             "set yrange [{1}:0]\nset arrow from 0.1,{2} to {3},{2} nohead linewidth 1\n"
             "plot -1 notitle\n",
             width_cm, height_cm, 2.55 * kLine_cm, width_cm - 0.1);
}

}  // namespace mh
