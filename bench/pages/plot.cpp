// SPDX-License-Identifier: Apache-2.0
#include "bench/pages/plot.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>

#include <fmt/format.h>

#include "bench/pages/curves.hpp"
#include "bench/plan/outside_program.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/core/legible.hpp"
#include "slam/core/suggest.hpp"
#include "slam/core/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Dark to light: they stay apart in gray and for the color-blind.
constexpr const char* kInks[] = {"#0065a3", "#d98a00", "#00805d", "#b4568c", "#3a9bd9", "#a33f00"};
const char* ink_of(std::size_t i) {
  return kInks[i % std::size(kInks)];
}

/// A text as gnuplot's single quotes hold it: nothing in it is interpreted.
std::string gnuplot_text(const std::string& text) {
  std::string quoted = "'";
  for (const char c : legible(text)) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

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

std::string beginning(const PlotOrder& order, const fs::path& pdf, double height_cm) {
  return fmt::format(
      "set terminal pdfcairo size {}cm,{}cm font 'DejaVu Sans,8' fontscale 0.8 linewidth 1\n"
      "set output {}\nset key outside top center horizontal noenhanced samplen 2\nset border "
      "3\nset tics nomirror "
      "out scale 0.5\nset grid linecolor '#dddddd' linewidth 0.5\n",
      order.width_cm, height_cm, gnuplot_text(pdf.string()));
}

/// Figure 3: boxes by group and system, means as open diamonds.
std::string by_density(const PagesSource& source, const PlotOrder& order, const fs::path& pdf) {
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
  std::vector<std::string> systems;
  std::map<std::pair<std::size_t, std::string>, std::string> data;  // by system, group
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string system = table.text("system", row);
    auto known = std::ranges::find(systems, system);
    if (known == systems.end()) known = systems.insert(known, system);
    if (const auto value = table.number(order.measure, row))
      data[{static_cast<std::size_t>(known - systems.begin()), table.text("group", row)}] +=
          fmt::format("{}\n", scale * *value);
  }
  std::string script = beginning(order, pdf, 0.75 * order.width_cm), plots, ticks;
  std::size_t block = 0;
  for (std::size_t g = 0; g < json.at("groups").size(); ++g) {
    const std::string group = json.at("groups").at(g);
    ticks += fmt::format("{}{} {}", g == 0 ? "" : ", ", gnuplot_text(group), g);
    for (std::size_t s = 0; s < systems.size(); ++s) {
      const auto found = data.find({s, group});
      if (found == data.end()) continue;
      const double at =
          static_cast<double>(g) + 0.3 * (static_cast<double>(s) - 0.5 * (systems.size() - 1.0));
      script += fmt::format("$d{0} << EOD\n{1}EOD\nstats $d{0} nooutput name 's{0}'\n", block,
                            found->second);
      plots += fmt::format(
          "{0}$d{1} using ({2}):1:(0.24) with boxplot linecolor rgb '{3}' notitle, '+' using "
          "({2}):(s{1}_mean) every ::0::0 with points pointtype 12 pointsize 0.7 linecolor rgb "
          "'black' notitle",
          block == 0 ? "" : ", ", block, at, ink_of(s));
      ++block;
    }
  }
  for (std::size_t s = 0; s < systems.size(); ++s)
    plots += fmt::format(", 1/0 with lines linewidth 3 linecolor rgb '{}' title {}", ink_of(s),
                         gnuplot_text(systems[s]));
  const std::string unit = column->at("unit").get<std::string>();
  return script +
         fmt::format(
             "set style boxplot outliers pointtype 7\nset style fill solid 0.25 border\n"
             "set pointsize 0.25\nset xtics ({})\nset xrange [-0.6:{}]\nset yrange [0:*]\n"
             "set xlabel 'objects per 10 m²'\nset ylabel {} noenhanced\nplot {}\n",
             ticks, static_cast<double>(json.at("groups").size()) - 0.4,
             gnuplot_text(column->at("title").get<std::string>() + (unit == "%" ? ", %" : "")),
             plots);
}

/// Figure 4: error against frames, and below it the environments still counted.
std::string by_frame(const PagesSource& source, const PlotOrder& order, const fs::path& pdf) {
  const Json json = error_by_frame_json(source);
  if (json.is_null())
    throw InputError(
        fmt::format("{}: no run has both a true and an estimated path: figure 4 "
                    "cannot be drawn",
                    source.name));
  const PlotTable table(json);
  std::vector<std::pair<std::string, std::string>> arms;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string labels = table.text("labels", row);
    const std::string arm =
        table.text("system", row) + (labels == "none" ? "" : ", " + labels + " labels");
    auto known = std::ranges::find(arms, arm, &std::pair<std::string, std::string>::first);
    if (known == arms.end()) known = arms.insert(known, {arm, ""});
    const double error = table.number("error_m", row).value_or(0);
    known->second += fmt::format("{} {} {} {} {}\n", table.number("frame", row).value_or(0), error,
                                 table.number("low", row).value_or(error),
                                 table.number("high", row).value_or(error),
                                 table.number("scenes", row).value_or(0));
  }
  std::string script = beginning(order, pdf, order.width_cm), errors, counts;
  for (std::size_t a = 0; a < arms.size(); ++a) {
    script += fmt::format("$a{} << EOD\n{}EOD\n", a, arms[a].second);
    errors += fmt::format(
        "{0}$a{1} using 1:3:4 with filledcurves fillcolor rgb '{2}' fillstyle transparent solid "
        "0.2 noborder notitle, $a{1} using 1:2 with lines linewidth 2 dashtype {3} linecolor rgb "
        "'{2}' title {4}",
        a == 0 ? "" : ", ", a, ink_of(a), a + 1, gnuplot_text(arms[a].first));
    counts += fmt::format(
        "{}$a{} using 1:5 with steps linewidth 2 dashtype {} linecolor rgb '{}' "
        "notitle",
        a == 0 ? "" : ", ", a, a + 1, ink_of(a));
  }
  return script + fmt::format(
                      "set multiplot\nset lmargin 11\nset size 1,0.66\nset origin 0,0.34\n"
                      "set ylabel 'mean position error, m'\nset yrange [0:*]\nplot {}\n"
                      "set size 1,0.36\nset origin 0,0\nset ylabel 'environments'\n"
                      "set xlabel 'frame of the tour'\nplot {}\nunset multiplot\n",
                      errors, counts);
}

/// Figures 2 and 5: true and estimated path, x and o of the queries.
std::string from_above(const PagesSource& source, const PlotOrder& order, const fs::path& pdf) {
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
  std::string truth, estimate, asked, right, wrong;
  for (const TimedPose& pose : run->truth) truth += place(pose.world_from_camera.translation());
  for (const TimedPose& pose : run->estimate)
    estimate += place(to_dock * pose.world_from_camera.translation());
  if (!run->points.empty()) {
    const PointResult& point = run->points.front();
    const auto& list = point.second_tour.empty() ? point.held_out : point.second_tour;
    for (const QueryScore& q : list) {
      if (q.true_world_from_camera) asked += place(q.true_world_from_camera->translation());
      if (q.answer.world_from_camera)
        (q.correct ? right : wrong) += place(to_dock * q.answer.world_from_camera->translation());
    }
  }
  std::string script = beginning(order, pdf, 0.9 * order.width_cm), plots;
  const auto add = [&](const char* name, const std::string& data, const std::string& style) {
    if (data.empty()) return;
    script += fmt::format("${} << EOD\n{}EOD\n", name, data);
    plots += fmt::format("{}${} using 1:2 {}", plots.empty() ? "" : ", ", name, style);
  };
  add("truth", truth, "with lines linewidth 1 linecolor rgb 'black' title 'true path'");
  add("estimate", estimate,
      "with lines linewidth 1.5 dashtype 2 linecolor rgb '#0065a3' title 'estimated path'");
  add("asked", asked,
      "with points pointtype 2 pointsize 0.5 linecolor rgb 'black' title 'queries'");
  add("right", right,
      "with points pointtype 6 pointsize 0.6 linecolor rgb '#00805d' title 'correct answers'");
  add("wrong", wrong,
      "with points pointtype 8 pointsize 0.7 linecolor rgb '#a33f00' title 'false answers'");
  if (plots.empty())
    throw InputError(
        fmt::format("{}: neither a true nor an estimated path is known", run->spec.name));
  return script +
         "set size ratio -1\nset xtics rotate by 90 right\nset key outside top center "
         "horizontal\nset xlabel 'x, m'\n"
         "set ylabel 'y, m'\nplot " +
         plots + "\n";
}

}  // namespace

std::string plot_script(const PagesSource& source, const PlotOrder& order, const fs::path& pdf) {
  if (!source.suite) throw InputError(fmt::format("{}: {}", source.name, source.problem));
  switch (order.figure) {
    case 2:
    case 5:
      return from_above(source, order, pdf);
    case 3:
      return by_density(source, order, pdf);
    case 4:
      return by_frame(source, order, pdf);
    default:
      throw InputError(fmt::format("figure {} is not drawn; 2, 3, 4 and 5 are", order.figure));
  }
}

void write_plot(const fs::path& pdf, const PagesSource& source, const PlotOrder& order) {
  const TemporaryFolder work(fs::temp_directory_path());
  const fs::path script = work.path() / "figure.gnuplot", errors = work.path() / "errors.txt";
  write_atomically(pdf, [&](const fs::path& temporary) {
    write_atomically(script, plot_script(source, order, fs::absolute(temporary)));
    const int ended = std::system(fmt::format("gnuplot {} > {} 2>&1", shell_quoted(script.string()),
                                              shell_quoted(errors.string()))
                                      .c_str());
    if (ended == 0 && is_file(temporary)) return;
    const std::string said = is_file(errors) ? legible(read_file(errors)) : std::string();
    throw MachineError(fmt::format("gnuplot cannot draw the figure (Debian: gnuplot-nox): {}",
                                   said.substr(0, 300)));
  });
}

}  // namespace mh
