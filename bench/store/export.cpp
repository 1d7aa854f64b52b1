// SPDX-License-Identifier: Apache-2.0
#include "bench/store/export.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/results/summary.hpp"
#include "bench/run.hpp"

namespace mh {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string latex_cell(std::string_view text) {
  std::string safe;
  for (const char c : text)
    safe += std::string_view("&%$#_{}").find(c) == std::string_view::npos ? std::string(1, c)
                                                                          : std::string("\\") + c;
  return safe;
}

std::string cell(const std::optional<double>& value, const char* format = "{:.4f}") {
  return value ? fmt::format(fmt::runtime(format), *value) : std::string("--");
}

}  // namespace

std::string export_csv(const Store& store) {
  const Rows names = store.rows("SELECT DISTINCT name FROM metrics ORDER BY name");
  std::string columns;
  for (std::size_t i = 1; i < names.size(); ++i)
    columns += fmt::format(
        ", (SELECT value FROM metrics m WHERE m.key = r.key AND m.point = o.point AND m.name = "
        "'{0}') AS \"{0}\"",
        names[i][0]);
  const Rows rows = store.rows(
      "SELECT p.name AS run, r.environment, r.category, r.level, r.system, r.labels, r.trial, "
      "r.seed, r.status, r.error, o.point, o.gamma, o.xi, o.alpha, o.beta, o.overlap" +
      columns +
      " FROM plan p JOIN runs r ON r.key = p.key LEFT JOIN points o ON o.key = r.key "
      "ORDER BY p.position, o.point");
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
  for (const std::string table : {"runs", "points", "metrics", "calls", "frames", "queries"}) {
    const Rows rows = store.rows(fmt::format(
        "SELECT t.* FROM {} t JOIN (SELECT DISTINCT key, min(position) AS at FROM plan GROUP BY "
        "key) p ON p.key = t.key ORDER BY p.at, 2, 3, 4",
        table));
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t r = 1; r < rows.size(); ++r) {
      nlohmann::ordered_json object;
      for (std::size_t c = 0; c < rows[r].size(); ++c) object[rows[0][c]] = rows[r][c];
      list.push_back(std::move(object));
    }
    all[table] = std::move(list);
  }
  return all.dump(1) + "\n";
}

std::string export_latex(const Store& store) {
  const Suite suite = store.planned_suite();
  const BenchResults results = load_results(store, suite);
  std::string text =
      "\\begin{tabular}{lllllrrrrr}\n\\toprule\n"
      "environment & level & labels & system & queries & ATE (m) & RPE (m) & success & correct & "
      "distance (m) \\\\\n\\midrule\n";
  for (const Row& row : make_rows(suite, results.runs))
    for (const QuerySet set : kQuerySets) {
      const QuerySummary& s = summary(row, set);
      if (s.queries == 0) continue;
      text += fmt::format(
          "{} & {} & {} & {} & {} & {} & {} & {:.2f}\\,\\% & {:.2f}\\,\\% & {} \\\\\n",
          latex_cell(suite.environments[row.environment].name),
          latex_cell(level_name(suite.levels[row.level])), name(row.labels),
          latex_cell(suite.systems[row.system].name), latex_cell(name(set)),
          cell(row.trajectory.ate_rmse_m), cell(row.trajectory.rpe_frame_rmse_m, "{:.5f}"),
          100 * s.success, 100 * s.correct, cell(s.distance_mean_m));
    }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace mh
