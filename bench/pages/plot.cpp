// SPDX-License-Identifier: Apache-2.0
#include "bench/pages/plot.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "bench/drawing/gnuplot.hpp"
#include "bench/pages/curves.hpp"
#include "bench/pages/tables.hpp"
#include "bench/results/placed.hpp"
#include "slam/core/error.hpp"
#include "slam/core/suggest.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Dark to light: they stay apart in gray and for the color-blind.
constexpr const char* kInks[] = {"#0065a3", "#d98a00", "#00805d", "#b4568c", "#3a9bd9", "#a33f00"};
const char* ink_of(std::size_t i) {
  return kInks[i % std::size(kInks)];
}

/// The arms that a table has rows of, in the suite's order, each with the ink of its place there.
class InkOfArms {
 public:
  explicit InkOfArms(const Suite& suite) : suite_(suite), arms_(arms_of(suite)) {}
  /// @throws std::out_of_range for a row of no arm
  std::size_t place(const std::string& system, const std::string& labels) const {
    for (std::size_t i = 0; i < arms_.size(); ++i)
      if (suite_.systems[arms_[i].system].name == system && arms_[i].labels == labels) return i;
    throw std::out_of_range(system);
  }
  const std::string& name(std::size_t place) const { return arms_[place].name; }
  std::size_t count() const { return arms_.size(); }

 private:
  const Suite& suite_;
  std::vector<Arm> arms_;
};

/// A table that was written for pages.
class PlotTable {
 public:
  explicit PlotTable(const Json& json) : json_(json) {}
  std::size_t rows() const { return json_.at("rows").get<std::size_t>(); }
  const Json* column(const std::string& key) const {
    for (const Json& c : json_.at("columns"))
      if (c.at("key") == key) return &c;
    return nullptr;
  }
  std::string text(const std::string& key, std::size_t row) const {
    const Json* c = column(key);
    if (c == nullptr || c->at("values").at(row).is_null()) return "";
    return c->at("words").at(c->at("values").at(row).get<std::size_t>()).get<std::string>();
  }
  std::optional<double> number(const std::string& key, std::size_t row) const {
    const Json* c = column(key);
    if (c == nullptr || c->at("values").at(row).is_null()) return std::nullopt;
    return c->at("values").at(row).get<double>();
  }

 private:
  const Json& json_;
};

std::string beginning(const PlotOrder& order, const fs::path& file, double height_cm) {
  return gnuplot_terminal(file, order.width_cm, height_cm) +
         "set key outside top center horizontal noenhanced samplen 6\nset border 3\nset tics "
         "nomirror out scale 0.5\nset grid linecolor '#dddddd' linewidth 0.5\n";
}

/// A distance between ticks that leaves at most six of them: 1, 2 or 5 times a power of ten.
double tick_step(double range) {
  double step = 1;
  for (std::size_t i = 0; range / step > 5; ++i) step *= i % 3 == 1 ? 2.5 : 2;
  return step;
}

/// Whether one value would press the others to the axis: it is far beyond all but a few.
bool needs_logarithm(std::vector<double> values) {
  constexpr double kFar = 10;
  if (values.empty() || std::ranges::min(values) <= 0) return false;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return std::ranges::max(values) > kFar * *middle;
}

/// Figure 3: boxes by group and system, means as open diamonds.
std::string by_density(const PagesSource& source, const PlotOrder& order, const fs::path& file) {
  const std::vector<Row> rows =
      make_rows(*source.suite, source.results.runs, source.results.failed);
  const Json json = density_json(*source.suite, rows);
  if (json.is_null())
    throw InputError(
        fmt::format("{}: no environment was generated, so that the number of its "
                    "objects is unknown: figure 3 cannot be drawn",
                    source.name));
  const PlotTable table(json.at("table"));
  const Json* column = table.column(order.measure);
  if (column == nullptr || column->contains("words"))
    throw InputError(
        fmt::format("{}: no figures named '{}' (--measure)", source.name, order.measure));
  const double scale = column->at("unit") == "%" ? 100 : 1;
  const InkOfArms arms(*source.suite);
  std::map<std::pair<std::size_t, std::string>, std::string> data;  // by arm, group
  std::map<std::string, std::size_t> most_in;                       // environments, by group
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

/// Figure 4: error against frames, and below it the environments still counted.
std::string by_frame(const PagesSource& source, const PlotOrder& order, const fs::path& file) {
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
    // Lines that coincide are drawn beside one another.
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

/// Rectangles of cells in a state, by rows: middle and extent in each direction.
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

/// Figure 2: true and estimated path, x and o of the queries. Figure 5: the same on the grid of the
/// run's map.
std::string from_above(const PagesSource& source, const PlotOrder& order, const fs::path& file) {
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
  const SE3& to_dock = run->frames.dock_from_estimate;
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

/// A cell as a reader sees it.
std::string cell_of(const Json& column, std::size_t row) {
  const Json& value = column.at("values").at(row);
  if (value.is_null()) return "";
  if (column.contains("words")) return column.at("words").at(value.get<std::size_t>());
  const bool share = column.value("unit", "") == "%";
  return fmt::format("{:.{}f}", value.get<double>() * (share ? 100 : 1),
                     column.value("decimals", 0));
}

/// A table: of table 1 what the paper's shows, of table 2 everything; columns without a value are
/// left out. As wide as it needs to be.
std::string table_script(const PagesSource& source, const PlotOrder& order, const fs::path& file) {
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
    const std::string last_word = title.substr(title.rfind(' ') + 1);  // "RPE m/s" has its unit
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

}  // namespace

std::string plot_script(const PagesSource& source, const PlotOrder& order, const fs::path& file) {
  if (!source.suite) throw InputError(fmt::format("{}: {}", source.name, source.problem));
  if (order.table != 0) return table_script(source, order, file);
  switch (order.figure) {
    case 2:
    case 5:
      return from_above(source, order, file);
    case 3:
      return by_density(source, order, file);
    case 4:
      return by_frame(source, order, file);
    default:
      throw InputError(fmt::format("figure {} is not drawn; 2, 3, 4 and 5 are", order.figure));
  }
}

void write_plot(const fs::path& file, const PagesSource& source, const PlotOrder& order) {
  draw_by_gnuplot(file,
                  [&](const fs::path& temporary) { return plot_script(source, order, temporary); });
}

}  // namespace mh
