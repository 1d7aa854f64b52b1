// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/plot.hpp"

#include <fmt/format.h>

#include "bench/report/drawing/gnuplot.hpp"
#include "bench/report/pages/plot_parts.hpp"
#include "slam/io/error.hpp"

namespace mh {

std::string plot_script(const PagesSource& source, const PlotOrder& order,
                        const std::filesystem::path& file) {
  if (!source.suite) throw InputError(fmt::format("{}: {}", source.name, source.problem));
  if (order.table != 0) return plot_table(source, order, file);
  switch (order.figure) {
    case 2:
    case 5:
      return plot_from_above(source, order, file);
    case 3:
      return plot_by_density(source, order, file);
    case 4:
      return plot_by_frame(source, order, file);
    default:
      throw InputError(fmt::format("figure {} is not drawn; 2, 3, 4 and 5 are", order.figure));
  }
}

void write_plot(const std::filesystem::path& file, const PagesSource& source,
                const PlotOrder& order) {
  draw_by_gnuplot(file, [&](const std::filesystem::path& temporary) {
    return plot_script(source, order, temporary);
  });
}

}  // namespace mh
