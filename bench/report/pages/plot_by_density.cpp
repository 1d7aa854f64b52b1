// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "bench/report/drawing/gnuplot.hpp"
#include "bench/report/pages/curves.hpp"
#include "bench/report/pages/plot_parts.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Whether the largest value is so far above most others that a linear axis would squeeze these
/// together.
bool needs_logarithm(std::vector<double> values) {
  constexpr double kFar = 10;
  if (values.empty() || std::ranges::min(values) <= 0) return false;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return std::ranges::max(values) > kFar * *middle;
}

}  // namespace

/// Figure 3: a box for each group and system, with means as open diamonds.
std::string plot_by_density(const PagesSource& source, const PlotOrder& order,
                            const fs::path& file) {
  const std::vector<Row> rows =
      make_rows(*source.suite, source.results.runs, source.results.failed);
  const Json json = density_json(*source.suite, rows);
  if (json.is_null())
    throw InputError(
        fmt::format("{}: no environment was generated, so the number of its objects is unknown: "
                    "figure 3 cannot be drawn",
                    source.name));
  const PlotTable table(json.at("table"));
  const Json* column = table.column(order.measure);
  if (column == nullptr || column->contains("words"))
    throw InputError(
        fmt::format("{}: no figures named '{}' (--measure)", source.name, order.measure));
  const double scale = column->at("unit") == "%" ? 100 : 1;
  const InkOfArms arms(*source.suite);
  std::map<std::pair<std::size_t, std::string>, std::string> data;  // by arm, group
  std::map<std::string, std::size_t> most_in;                       // environment counts, by group
  std::vector<double> values;
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (const auto value = table.number(order.measure, row)) {
      values.push_back(*value);
      std::string& of = data[{arms.place(table.text("system", row), table.text("labels", row)),
                              table.text("group", row)}];
      of += fmt::format("{}\n", scale * *value);
      std::size_t& most = most_in[table.text("group", row)];
      most = std::max(most, static_cast<std::size_t>(std::ranges::count(of, '\n')));
    }
  const bool logarithmic = scale == 1 && needs_logarithm(values);
  const double step = 0.8 / static_cast<double>(arms.count());
  std::string script = beginning(order, file, 0.75 * order.width_cm), plots, ticks;
  std::size_t block = 0;
  for (std::size_t g = 0; g < json.at("groups").size(); ++g) {
    const std::string group = json.at("groups").at(g);
    const std::string counted = fmt::format("{}\nn {}", group, most_in[group]);
    ticks += fmt::format("{}{} {}", g == 0 ? "" : ", ", gnuplot_text(counted), g);
    for (std::size_t s = 0; s < arms.count(); ++s) {
      const auto found = data.find({s, group});
      if (found == data.end()) continue;
      const double at =
          static_cast<double>(g) + step * (static_cast<double>(s) - 0.5 * (arms.count() - 1.0));
      script += fmt::format("$d{0} << EOD\n{1}EOD\nstats $d{0} nooutput name 's{0}'\n", block,
                            found->second);
      plots += fmt::format(
          "{0}$d{1} using ({2}):1:({4}) with boxplot linecolor rgb '{3}' notitle, '+' using "
          "({2}):(s{1}_mean) every ::0::0 with points pointtype 12 pointsize 0.7 linecolor rgb "
          "'black' notitle",
          block == 0 ? "" : ", ", block, at, ink_of(s), 0.8 * step);
      ++block;
    }
  }
  for (std::size_t s = 0; s < arms.count(); ++s)
    plots += fmt::format(", 1/0 with lines linewidth 3 linecolor rgb '{}' title {}", ink_of(s),
                         gnuplot_text(arms.name(s)));
  const std::string unit = column->at("unit").get<std::string>();
  std::string title = column->at("title").get<std::string>();
  if (title.ends_with(" " + unit)) title.resize(title.size() - unit.size() - 1);
  return script + fmt::format(
                      "set style boxplot outliers pointtype 7\nset style fill solid 0.25 border\n"
                      "set pointsize 0.25\nset xtics ({})\nset xrange [-0.6:{}]\n{}\n"
                      "set bmargin 4.5\nset xlabel 'objects per 10 m²' offset 0,-0.9\n"
                      "set ylabel {} noenhanced\nplot {}\n",
                      ticks, static_cast<double>(json.at("groups").size()) - 0.4,
                      logarithmic ? "set logscale y" : "set yrange [0:*]",
                      gnuplot_text(unit.empty() ? title : title + ", " + unit), plots);
}

}  // namespace mh
