// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace mh {

/// Points of one plot: a line for the source's formula, dots for measurements. The first two series
/// have one color, the next two another, and so on.
struct Series {
  struct Point {
    double x = 0, y = 0;
  };
  std::string name;  ///< empty: not in the legend
  bool dots = false;
  std::vector<Point> points;
  std::vector<std::pair<double, double>> bars = {};  ///< from, to, at each point; or empty
};

/// Values over two settings, as shades: cells around whole numbers with the values in them, or
/// dots.
struct ShadedField {
  struct Mark {
    double x = 0, y = 0, value = 0;
    std::string text;  ///< of a cell
  };
  using Ticks = std::vector<std::pair<double, std::string>>;
  bool cells = true;
  std::vector<Mark> marks;
  Ticks x_ticks, y_ticks;
  std::string low_color = "#ecf3fb", high_color = "#084594";
  std::optional<std::size_t> framed = {};  ///< index of a mark
};

/// One panel: series, or a field.
struct Plot {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  std::optional<ShadedField> field = {};
  std::optional<std::pair<double, double>> x_range = {}, y_range = {};  ///< default: what is drawn
};

/// Panels under a heading, with lines of text below them.
struct PlotPage {
  std::string title;
  std::vector<Plot> plots;  ///< three in a row
  std::string caption = {};
};

/// The gnuplot script that draws a page: axes are linear, from zero unless all values are far from
/// it or a range is given.
std::string plots_script(const PlotPage& page, const std::filesystem::path& file);

/// Draws a page as .png or .pdf. @throws as draw_by_gnuplot()
void write_plots(const std::filesystem::path& file, const PlotPage& page);

}  // namespace mh
