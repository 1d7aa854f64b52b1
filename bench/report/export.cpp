// SPDX-License-Identifier: Apache-2.0
#include "bench/report/export.hpp"

#include <algorithm>
#include <map>
#include <type_traits>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/report/table2.hpp"
#include "bench/report/text_table.hpp"
#include "bench/report/wording.hpp"
#include "bench/results/rows.hpp"
#include "bench/store/store.hpp"
#include "slam/config/by_name.hpp"
#include "slam/config/slam.hpp"

namespace mh {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// LaTeX source for a character; "[U+6F22]" for one that is not supported.
std::string latex_character(char32_t c, std::string_view bytes) {
  if (c < 0x80 && std::string_view("&%$#_{}").find(static_cast<char>(c)) != std::string_view::npos)
    return "\\" + std::string(bytes);
  if (c == U'\\') return "\\textbackslash{}";
  if (c == U'~') return "\\textasciitilde{}";
  if (c == U'^') return "\\textasciicircum{}";
  if (c == U'<') return "\\textless{}";
  if (c == U'>') return "\\textgreater{}";
  if (c == U'|') return "\\textbar{}";
  if (c == U'²') return "$^2$";
  if (c == U'°') return "$^\\circ$";
  const bool is_letter = c < 0x80 || (c >= 0xc0 && c < 0x180);
  return is_letter ? std::string(bytes) : fmt::format("[U+{:04X}]", static_cast<unsigned>(c));
}

}  // namespace

std::string latex_cell(std::string_view text) {
  std::string safe;
  while (!text.empty()) {
    const auto first = static_cast<unsigned char>(text[0]);
    const std::size_t size = std::min<std::size_t>(first < 0xc0   ? 1
                                                   : first < 0xe0 ? 2
                                                   : first < 0xf0 ? 3
                                                                  : 4,
                                                   text.size());
    char32_t c = size == 1 ? first : first & (0x7fU >> size);
    for (std::size_t i = 1; i < size; ++i)
      c = c << 6U | (static_cast<unsigned char>(text[i]) & 0x3fU);
    safe += latex_character(c, text.substr(0, size));
    text.remove_prefix(size);
  }
  return safe;
}

/// "& ATE m & RPE m/fr": the headings of a trajectory's figures in an overview.

namespace {

std::string latex_trajectory_headings() {
  std::string text;
  for (const std::string& heading : trajectory_headings()) text += " & " + latex_cell(heading);
  return text;
}

/// "& 0.0123 & 87.50\,\%"; "& -- & --" if no trial succeeded.
std::string latex_trajectory(const TrajectoryScore& score, bool known) {
  std::string text;
  for (std::string cell : trajectory_cells(score, known)) {
    if (cell == "-") cell = "--";
    if (cell.ends_with('%')) cell.replace(cell.size() - 1, 1, "\\,\\%");
    text += " & " + cell;
  }
  return text;
}

/// "& success (\%) & mean distance (m)": the headings of Table 2's columns.
std::string latex_query_headings() {
  std::string text;
  for (const Table2Column& column : kTable2Columns)
    text +=
        " & " + latex_cell(column.unit.empty() ? std::string(column.title)
                                               : fmt::format("{} ({})", column.title, column.unit));
  return text;
}

/// The cells of Table 2's columns; "--" each if nothing was asked.
std::string latex_queries(const QuerySummary& summary) {
  std::string text;
  for (const Table2Column& column : kTable2Columns) {
    const auto value = summary.queries > 0 ? column.measured(summary) : std::nullopt;
    text += " & " + (value ? shown(column, value) : "--");
  }
  return text;
}

nlohmann::ordered_json to_json(const Store::Value& value) {
  return std::visit(
      [](const auto& v) {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
          return nlohmann::ordered_json();
        else
          return nlohmann::ordered_json(v);
      },
      value);
}

}  // namespace

/// Appends a column to a table of runs and points for each setting that a sweep varies. The table's
/// first row contains the column names. Cells are empty for a system that ignores settings.
void add_varied(const Suite& suite, Rows& rows) {
  const std::vector<std::string>& varied = suite.sweep.varied;
  std::map<std::string, RunSpec> spec_of;
  if (!varied.empty())
    for (RunSpec& spec : expand(suite)) spec_of.emplace(spec.name, spec);
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::ranges::find(rows[0], name) - rows[0].begin());
  };
  const std::size_t run = column("run"), point = column("point");
  for (const std::string& name : varied) {
    for (std::size_t r = 1; r < rows.size(); ++r) {
      const RunSpec& spec = spec_of.at(rows[r][run]);
      SlamConfig at = spec.slam;
      if (!rows[r][point].empty()) at.semantics = spec.points.at(std::stoul(rows[r][point]));
      rows[r].push_back(spec.system.takes_settings() ? setting_text(at, name) : "");
    }
    rows[0].push_back(name);
  }
}

std::string export_csv(const Store& store) {
  const Rows names = store.rows("SELECT DISTINCT name FROM metrics ORDER BY name");
  std::string columns;
  for (std::size_t i = 1; i < names.size(); ++i)
    columns += fmt::format(
        ", (SELECT value FROM metrics m WHERE m.key = r.key AND m.point = o.point AND m.name = "
        "'{0}') AS \"{0}\"",
        names[i][0]);
  std::string settings;
  const auto add = [&](const char* name, const auto&, const SettingRange&, const char*) {
    settings += fmt::format(", o.{}", name);
  };
  const SemanticConfig any;
  fields(any, add);
  Rows rows = store.rows(
      "SELECT p.name AS run, r.environment, r.category, r.level, r.system, r.labels, r.trial, "
      "r.seed, r.status, r.error, o.point" +
      settings + columns +
      " FROM plan p JOIN runs r ON r.key = p.key LEFT JOIN points o ON o.key = r.key "
      "ORDER BY p.position, o.point");
  add_varied(store.planned_suite(), rows);
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c)
      text.append(c > 0 ? "," : "").append(csv_cell(row[c]));
    text += "\n";
  }
  return text;
}

std::string export_json(const Store& store) {
  nlohmann::ordered_json all;
  for (const std::string table :
       {"runs", "points", "metrics", "calls", "frames", "queries", "episodes"}) {
    const auto rows = store.values(fmt::format(
        "SELECT t.* FROM {} t JOIN (SELECT DISTINCT key, min(position) AS at FROM plan GROUP BY "
        "key) p ON p.key = t.key ORDER BY p.at, 2, 3, 4",
        table));
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t r = 1; r < rows.size(); ++r) {
      nlohmann::ordered_json object;
      for (std::size_t c = 0; c + 1 < rows[r].size(); ++c)  // the last column is the digest
        object[std::get<std::string>(rows[0][c])] = to_json(rows[r][c]);
      list.push_back(std::move(object));
    }
    all[table] = std::move(list);
  }
  return all.dump(1) + "\n";
}

/// "$\\gamma$ & features.count & "
std::string latex_headings(const Sweep& sweep) {
  constexpr std::array<std::string_view, 4> kGreek{"gamma", "xi", "alpha", "beta"};
  std::string text;
  for (const std::string& name : sweep.varied) {
    const std::string_view shown = shown_name(name);
    const bool is_symbol = std::ranges::count(kGreek, shown) > 0;
    text += (is_symbol ? fmt::format("$\\{}$", shown) : latex_cell(shown)) + " & ";
  }
  return text;
}

std::string export_latex(const Store& store) {
  const Suite suite = store.planned_suite();
  const BenchResults results = load_results(store, suite);
  const std::vector<SharedSlamConfig> points = parameter_points(suite);
  std::string headings = "environment & level & labels & system & " + latex_headings(suite.sweep) +
                         "trials" + latex_trajectory_headings() + " & query set" +
                         latex_query_headings();
  const auto columns = static_cast<std::size_t>(std::ranges::count(headings, '&')) + 1;
  std::string text = fmt::format("\\begin{{tabular}}{{llll{}}}\n\\toprule\n{} \\\\\n\\midrule\n",
                                 std::string(columns - 4, 'r'), headings);
  for (const Row& row : make_rows(suite, results.runs, results.failed)) {
    const SystemSpec& system = suite.systems[row.system];
    const SlamConfig seen = settings_of(system, points[row.parameters]);
    const auto same = [&](const SlamConfig& point) { return settings_of(system, point) == seen; };
    // Parameter points that a system ignores get no rows of their own.
    if (std::any_of(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(row.parameters),
                    same))
      continue;
    std::string head =
        fmt::format("{} & {} & {} & {} & ", latex_cell(suite.environments[row.environment].name),
                    latex_cell(level_name(suite.levels[row.level])), latex_cell(name(row.labels)),
                    latex_cell(system.name));
    for (const std::string& name : suite.sweep.varied)
      head += (system.takes_settings() ? latex_cell(shown_value(seen, name)) : "--") + " & ";
    const auto trials = static_cast<std::size_t>(suite.trials);
    head += row.trials.size() == trials ? fmt::format("{}", trials)
                                        : fmt::format("{} of {}", row.trials.size(), trials);
    if (row.failed > 0) head += fmt::format(", {} failed", row.failed);
    head += latex_trajectory(row.trajectory, !row.trials.empty());
    const auto add_row = [&](std::string_view set, const QuerySummary& summary) {
      text += head + " & " + latex_cell(set) + latex_queries(summary) + " \\\\\n";
    };
    bool asked = false;
    for (const QuerySet set : kQuerySets) {
      if (summary(row, set).queries == 0) continue;
      asked = true;
      add_row(name(set), summary(row, set));
    }
    if (!asked) add_row("--", {});
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace mh
