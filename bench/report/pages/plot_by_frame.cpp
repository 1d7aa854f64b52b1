// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "bench/report/drawing/gnuplot.hpp"
#include "bench/report/pages/curves.hpp"
#include "bench/report/pages/plot_parts.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The distance between ticks: the smallest of 1, 2, 5, 10, 20, ... with at most six ticks.
double tick_step(double range) {
  double step = 1;
  for (std::size_t i = 0; range / step > 5; ++i) step *= i % 3 == 1 ? 2.5 : 2;
  return step;
}

}  // namespace

/// Figure 4: error against frames and, below it, the number of environments that the mean is over.
std::string plot_by_frame(const PagesSource& source, const PlotOrder& order, const fs::path& file) {
  const Json json = error_by_frame_json(
      *source.suite, make_rows(*source.suite, source.results.runs, source.results.failed));
  if (json.is_null())
    throw InputError(
        fmt::format("{}: no run has both a true and an estimated path: figure 4 "
                    "cannot be drawn",
                    source.name));
  const PlotTable table(json);
  const InkOfArms arms(*source.suite);
  std::vector<std::string> data(arms.count());
  double last_frame = 1, most_scenes = 1;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double frame = table.number("frame", row).value_or(0),
                 scenes = table.number("scenes", row).value_or(0);
    last_frame = std::max(last_frame, frame);
    most_scenes = std::max(most_scenes, scenes);
    const auto cell = [&](const char* key) {
      const auto value = table.number(key, row);
      return value ? fmt::format("{}", *value) : std::string("NaN");
    };
    data[arms.place(table.text("system", row), table.text("labels", row))] +=
        fmt::format("{} {} {} {} {}\n", frame, cell("error_m"), cell("low"), cell("high"), scenes);
  }
  std::string script = beginning(order, file, order.width_cm), errors, counts;
  for (std::size_t a = 0; a < arms.count(); ++a) {
    if (data[a].empty()) continue;
    script += fmt::format("$a{} << EOD\n{}EOD\n", a, data[a]);
    errors += fmt::format(
        "{0}$a{1} using 1:3:4 with filledcurves fillcolor rgb '{2}' fillstyle transparent solid "
        "0.2 noborder notitle, $a{1} using 1:2 with lines linewidth 2 dashtype {3} linecolor rgb "
        "'{2}' title {4}",
        errors.empty() ? "" : ", ", a, ink_of(a), a + 1, gnuplot_text(arms.name(a)));
    // Lines that would coincide are drawn side by side.
    counts += fmt::format(
        "{}$a{} using 1:($5+{}) with steps linewidth 2 dashtype {} linecolor rgb '{}' "
        "notitle",
        counts.empty() ? "" : ", ", a,
        0.008 * most_scenes * (static_cast<double>(a) - 0.5 * (arms.count() - 1.0)), a + 1,
        ink_of(a));
  }
  return script +
         fmt::format(
             "set multiplot\nset lmargin 11\nset size 1,0.66\nset origin 0,0.34\n"
             "set ylabel 'mean position error, m'\nset yrange [0:*]\nset xtics {}\n"
             "set xrange [0:{}]\nplot {}\n"
             "set size 1,0.36\nset origin 0,0\nset ylabel 'environments'\nset ytics {}\n"
             "set yrange [0:{}]\nset xlabel 'frame of the tour'\nplot {}\nunset multiplot\n",
             tick_step(last_frame), last_frame, errors, tick_step(most_scenes), 1.1 * most_scenes,
             counts);
}

}  // namespace mh
