// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/plot.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "bench/report/drawing/gnuplot.hpp"

namespace mh {
namespace {

constexpr std::size_t kColumns = 3;
constexpr double kPanelWidth_cm = 9.0, kPanelHeight_cm = 6.8, kHeader_cm = 1.0, kLine_cm = 0.45;
constexpr const char* kColors[] = {"#1f77b4", "#d62728", "#2ca02c", "#ff7f0e", "#9467bd"};

struct Extent {
  double least = std::numeric_limits<double>::max();
  double most = std::numeric_limits<double>::lowest();
  void take(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  /// The axis starts at zero if the smallest value is below half of the largest.
  std::string range() const { return least > 0 && least < 0.5 * most ? "[0:*]" : "[*:*]"; }
};

std::string range(const std::optional<std::pair<double, double>>& given, const Extent& drawn) {
  return given ? fmt::format("[{}:{}]", given->first, given->second) : drawn.range();
}

std::string lines_and_dots(const Plot& plot, std::size_t panel) {
  Extent across, up;
  std::string data, plots;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const Series& series = plot.series[s];
    if (series.points.empty()) continue;
    const std::string block = fmt::format("$p{}_{}", panel, s);
    data += block + " << EOD\n";
    for (std::size_t i = 0; i < series.points.size(); ++i) {
      const auto [x, y] = series.points[i];
      across.take(x);
      up.take(y);
      data += fmt::format("{} {}", x, y);
      if (!series.bars.empty()) {
        const auto [from, to] = series.bars[i];
        up.take(from);
        up.take(to);
        data += fmt::format(" {} {}", from, to);
      }
      data += '\n';
    }
    data += "EOD\n";
    const char* color = kColors[s / 2 % std::size(kColors)];
    const std::string title =
        series.name.empty() ? "notitle" : "title " + gnuplot_text(series.name);
    const char* style = !series.bars.empty()
                            ? "using 1:2:3:4 with yerrorbars pointtype 7 pointsize 0.6"
                        : series.dots ? "using 1:2 with points pointtype 7 pointsize 0.6"
                                      : "using 1:2 with lines linewidth 1.5";
    plots += fmt::format("{}{} {} linecolor rgb '{}' {}", plots.empty() ? "plot " : ", ", block,
                         style, color, title);
  }
  if (plots.empty()) return "";
  return data + fmt::format("set xrange {}\nset yrange {}\n{}\n", range(plot.x_range, across),
                            range(plot.y_range, up), plots);
}

std::string ticks(const ShadedField::Ticks& ticks) {
  std::string list;
  for (const auto& [at, text] : ticks) {
    std::string format;  // gnuplot reads tick text as a format: escape %
    for (const char c : text) format += c == '%' ? std::string("%%") : std::string(1, c);
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", gnuplot_text(format), at);
  }
  return "(" + list + ")";
}

std::string shaded(const ShadedField& field, std::size_t panel) {
  Extent values, across, up;
  for (const ShadedField::Mark& mark : field.marks) {
    values.take(mark.value);
    across.take(mark.x);
    up.take(mark.y);
  }
  if (field.marks.empty()) return "";
  const double span = std::max(values.most - values.least, 1e-9);
  std::string data = fmt::format("$p{} << EOD\n", panel), labels;
  std::size_t tag = 10;
  for (const ShadedField::Mark& mark : field.marks) {
    data += fmt::format("{} {} {}\n", mark.x, mark.y, mark.value);
    if (mark.text.empty()) continue;
    labels += fmt::format("set label {} {} at {},{} center front textcolor rgb '{}'\n", tag++,
                          gnuplot_text(mark.text), mark.x, mark.y,
                          mark.value - values.least > 0.5 * span ? "white" : "black");
  }
  data += "EOD\n";
  const double aside_x = field.cells ? 0.5 : 0.06 * std::max(across.most - across.least, 1e-9);
  const double aside_y = field.cells ? 0.5 : 0.06 * std::max(up.most - up.least, 1e-9);
  std::string frame, ring;
  if (field.framed) {
    const ShadedField::Mark& mark = field.marks[*field.framed];
    if (field.cells)
      frame = fmt::format(
          "set object 1 rectangle from {},{} to {},{} front fillstyle empty border linecolor rgb "
          "'#d62728' linewidth 2.5\n",
          mark.x - 0.5, mark.y - 0.5, mark.x + 0.5, mark.y + 0.5);
    else
      ring = fmt::format(
          ", '+' using ({}):({}) every ::0::0 with points pointtype 6 pointsize 2 linewidth 2 "
          "linecolor rgb '#d62728' notitle",
          mark.x, mark.y);
  }
  const std::string style =
      field.cells ? fmt::format(
                        "using 1:2:($1-0.5):($1+0.5):($2-0.5):($2+0.5):3 with boxxyerror "
                        "fillstyle solid noborder")
                  : "using 1:2:3 with points pointtype 7 pointsize 1.3";
  return data + labels + frame +
         fmt::format(
             "set palette defined (0 '{}', 1 '{}')\nset cbrange [{}:{}]\nunset colorbox\nunset "
             "grid\nset xtics {} noenhanced\nset ytics {} noenhanced\nset xrange [{}:{}]\nset "
             "yrange [{}:{}]\nplot $p{} {} linecolor palette notitle{}\nunset label\nunset "
             "object\nset grid\nset xtics autofreq\nset ytics autofreq\n",
             field.low_color, field.high_color, values.least, values.least + span,
             ticks(field.x_ticks), ticks(field.y_ticks), across.least - aside_x,
             across.most + aside_x, up.least - aside_y, up.most + aside_y, panel, style, ring);
}

}  // namespace

std::string plots_script(const PlotPage& page, const std::filesystem::path& file) {
  const std::size_t rows = std::max<std::size_t>(1, (page.plots.size() + kColumns - 1) / kColumns);
  const auto lines = page.caption.empty()
                         ? 0.0
                         : 1.0 + static_cast<double>(std::ranges::count(page.caption, '\n'));
  const double foot_cm = lines * kLine_cm;
  const double height_cm = kHeader_cm + static_cast<double>(rows) * kPanelHeight_cm + foot_cm;
  std::string script =
      gnuplot_terminal(file, kColumns * kPanelWidth_cm, height_cm) +
      "set border 3 back\nset tics back nomirror out scale 0.5\nset grid back linecolor '#dddddd' "
      "linewidth 0.5\nset key below center horizontal noenhanced samplen 2\n";
  script += fmt::format("set label 1 {} at screen 0.5,{} center noenhanced font ',12'\n",
                        gnuplot_text(page.title), 1 - 0.5 * kHeader_cm / height_cm);
  if (!page.caption.empty())
    script += fmt::format("set label 2 {} at screen 0.01,{} noenhanced\n",
                          gnuplot_text(page.caption), (foot_cm - 0.6 * kLine_cm) / height_cm);
  script += "set multiplot\n";
  const double panel_height = kPanelHeight_cm / height_cm;
  for (std::size_t i = 0; i < page.plots.size(); ++i) {
    const Plot& plot = page.plots[i];
    const std::string content = plot.field ? shaded(*plot.field, i) : lines_and_dots(plot, i);
    if (content.empty()) continue;
    const double above = static_cast<double>(rows - 1 - i / kColumns);
    script += fmt::format(
        "set size {},{}\nset origin {},{}\nset title {} noenhanced\nset xlabel {} noenhanced\nset "
        "ylabel {} noenhanced\n",
        1.0 / kColumns, panel_height, static_cast<double>(i % kColumns) / kColumns,
        foot_cm / height_cm + above * panel_height, gnuplot_text(plot.title),
        gnuplot_text(plot.x_label), gnuplot_text(plot.y_label));
    script += content + "unset label 1\nunset label 2\n";
  }
  return script + "unset multiplot\n";
}

void write_plots(const std::filesystem::path& file, const PlotPage& page) {
  draw_by_gnuplot(
      file, [&](const std::filesystem::path& temporary) { return plots_script(page, temporary); });
}

}  // namespace mh
