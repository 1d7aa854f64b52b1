// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace mh {

/// The points of one line or set of dots in a plot: a line for the source's formula, dots for
/// measurements. The first two series have one color, the next two another, and so on.
struct Series {
  struct Point {
    double x = 0, y = 0;
  };
  std::string name;  ///< empty: not shown in the legend
  bool dots = false;
  std::vector<Point> points;
  std::vector<std::pair<double, double>> bars = {};  ///< from and to, for each point; may be empty
};

/// Values over two settings, shown as shades: either as cells around whole numbers, with the value
/// written in each cell, or as dots.
struct ShadedField {
  struct Mark {
    double x = 0, y = 0, value = 0;
    std::string text;  ///< written in a cell
  };
  using Ticks = std::vector<std::pair<double, std::string>>;
  bool cells = true;
  std::vector<Mark> marks;
  Ticks x_ticks, y_ticks;
  std::string low_color = "#ecf3fb", high_color = "#084594";
  std::optional<std::size_t> framed = {};  ///< index of the framed mark
};

/// One panel: either series or a shaded field.
struct Plot {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  std::optional<ShadedField> field = {};
  std::optional<std::pair<double, double>> x_range = {}, y_range = {};  ///< default: fits the data
};

/// Panels under a heading, with lines of text below them.
struct PlotPage {
  std::string title;
  std::vector<Plot> plots;  ///< three per row
  std::string caption = {};
};

/// The gnuplot script that draws a page. Axes are linear; they start at zero unless all values are
/// far from it or a range is given.
std::string plots_script(const PlotPage& page, const std::filesystem::path& file);

/// Draws a page as .png or .pdf. @throws as draw_by_gnuplot()
void write_plots(const std::filesystem::path& file, const PlotPage& page);

}  // namespace mh
