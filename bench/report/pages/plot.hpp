// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "bench/report/pages/source.hpp"

namespace mh {

/// Which figure or table to draw for a paper.
struct PlotOrder {
  int figure = 3;  ///< in the paper: 2 (a run from above), 3 (by density), 4 (by frames), 5 (a run
                   ///< on the grid of its map)
  int table = 0;   ///< 1 or 2, as in the paper: draws this table instead of a figure
  std::string run = {};                ///< run that figures 2 and 5 show; empty: the first
  std::string measure = "ate_rmse_m";  ///< key of the column that figure 3 shows
  double width_cm = 8.5;               ///< the width of a column in a paper
};

/// The gnuplot script that draws a figure into a file; it contains the data.
/// @throws InputError if the results lack the data that the figure shows, or a name is unknown.
std::string plot_script(const PagesSource& source, const PlotOrder& order,
                        const std::filesystem::path& file);

/// Draws a figure as .pdf (vectors, fonts embedded) or .png.
/// @throws InputError as plot_script(), and as draw_by_gnuplot()
void write_plot(const std::filesystem::path& file, const PagesSource& source,
                const PlotOrder& order);

}  // namespace mh
