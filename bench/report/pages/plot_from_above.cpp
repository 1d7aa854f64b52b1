// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "bench/report/drawing/gnuplot.hpp"
#include "bench/report/pages/plot_parts.hpp"
#include "slam/io/error.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The cells of a grid in a given state, merged along rows into rectangles: one line per rectangle
/// with its middle and its extent along both axes.
std::string cells_in(const OccupancyGrid& grid, std::int8_t state) {
  std::string text;
  const double half_m = 0.5 * grid.resolution_m;
  for (int y = 0; y < grid.cells.height(); ++y)
    for (int x = 0; x < grid.cells.width(); ++x) {
      if (grid.cells(x, y) != state) continue;
      const int first = x;
      while (x + 1 < grid.cells.width() && grid.cells(x + 1, y) == state) ++x;
      const Eigen::Vector2d from = grid.center_m(first, y), to = grid.center_m(x, y);
      text += fmt::format("{} {} {} {} {} {}\n", 0.5 * (from.x() + to.x()), from.y(),
                          from.x() - half_m, to.x() + half_m, from.y() - half_m, to.y() + half_m);
    }
  return text;
}

}  // namespace

/// Figure 2: true and estimated path, with an x and an o for each query. Figure 5: the same drawn
/// on the grid of the run's map.
std::string plot_from_above(const PagesSource& source, const PlotOrder& order,
                            const fs::path& file) {
  const std::vector<RunResult>& runs = source.results.runs;
  const auto run =
      order.run.empty()
          ? runs.begin()
          : std::ranges::find(runs, order.run, [](const RunResult& r) { return r.spec.name; });
  if (run == runs.end()) {
    const auto names = words_of(runs, [](const RunResult& r) { return r.spec.name; });
    throw InputError(runs.empty() ? source.name + ": holds no finished run"
                                  : fmt::format("{}: holds no run '{}'{}", source.name, order.run,
                                                hint(order.run, names)));
  }
  const SE3& to_dock = run->alignment.dock_from_estimate;
  const auto place = [](const Eigen::Vector3d& at) {
    return fmt::format("{} {}\n", at.x(), at.y());
  };
  std::string truth, estimate, asked, right, wrong, errors, queries;
  for (const TimedPose& pose : run->truth) truth += place(pose.world_from_camera.translation());
  for (const TimedPose& pose : run->estimate)
    estimate += place(to_dock * pose.world_from_camera.translation());
  if (!run->points.empty()) {
    const PointResult& point = run->points.front();
    const auto& list = point.second_tour.empty() ? point.held_out : point.second_tour;
    queries = point.second_tour.empty() ? "held-out queries" : "queries of the second tour";
    const QuerySet set = point.second_tour.empty() ? QuerySet::kHeldOut : QuerySet::kSecondTour;
    for (const QueryScore& q : list) {
      if (q.true_world_from_camera) asked += place(q.true_world_from_camera->translation());
      const auto answer = answer_in_truth(*run, set, q);
      if (!answer) continue;
      (q.false_positive ? wrong : right) += place(answer->translation());
      if (q.true_world_from_camera)
        errors +=
            place(q.true_world_from_camera->translation()) + place(answer->translation()) + "\n";
    }
  }
  std::string script = beginning(order, file, 0.9 * order.width_cm), plots;
  const auto add = [&](const char* name, const std::string& data, const std::string& style,
                       const char* columns = "1:2") {
    if (data.empty()) return;
    script += fmt::format("${} << EOD\n{}EOD\n", name, data);
    plots += fmt::format("{}${} using {} {}", plots.empty() ? "" : ", ", name, columns, style);
  };
  if (order.figure == 5) {
    const auto grid = grid_of(source, *run);
    if (!grid)
      throw InputError(fmt::format("{}: left no grid, which figure 5 shows", run->spec.name));
    const std::string style = "with boxxyerror fillstyle solid noborder fillcolor rgb ";
    add("free", cells_in(*grid, kFreeCell), style + "'#e9edf0' notitle", "1:2:3:4:5:6");
    add("occupied", cells_in(*grid, kOccupiedCell), style + "'#8a8f98' title 'obstacle'",
        "1:2:3:4:5:6");
    script += "unset grid\n";
  }
  add("truth", truth, "with lines linewidth 1 linecolor rgb 'black' title 'true path'");
  add("estimate", estimate,
      "with lines linewidth 1.5 dashtype 2 linecolor rgb '#0065a3' title 'estimated path'");
  add("errors", errors, "with lines linewidth 1 linecolor rgb '#777777' notitle");
  add("asked", asked,
      "with points pointtype 2 pointsize 0.5 linecolor rgb 'black' title " + gnuplot_text(queries));
  add("right", right,
      "with points pointtype 6 pointsize 0.6 linecolor rgb '#00805d' title 'correct answers'");
  add("wrong", wrong,
      "with points pointtype 4 pointsize 0.7 linecolor rgb '#a33f00' title 'false answers'");
  if (plots.empty())
    throw InputError(
        fmt::format("{}: neither a true nor an estimated path is known", run->spec.name));
  return script +
         "set size ratio -1\nset key outside top center horizontal\nset xlabel 'x, m'\n"
         "set ylabel 'y, m'\nplot " +
         plots + "\n";
}

}  // namespace mh
