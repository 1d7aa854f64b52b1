// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/source.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/json_text.hpp"
#include "slam/io/printable.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A JSON file of the folder; null if it is missing or damaged. A damaged file is noted in
/// `source`.
/// @param keys  keys that the file must contain
Json json_file(PagesSource& source, const std::string& name,
               std::initializer_list<const char*> keys) {
  const fs::path file = source.folder / name;
  if (!is_file(file)) return nullptr;
  const Json json = parse_json_or_discard<Json>(read_file(file));
  if (json.is_object() &&
      std::ranges::all_of(keys, [&](const char* key) { return json.contains(key); }))
    return json;
  source.damaged.push_back(name);
  return nullptr;
}

double number_in(const Store::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  return 0;
}

/// Reads from the table of times what each run cost.
void read_costs(const Store& store, PagesSource& source) {
  const auto rows = store.values(
      "SELECT plan.name, wall_s, cpu_s, slam_s, frames_s, products_s, max_rss_mb, host FROM times "
      "JOIN plan ON plan.key = times.key");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto& row = rows[i];
    const auto* name = std::get_if<std::string>(&row[0]);
    if (name == nullptr) continue;
    source.cost_of[*name] = {.wall_s = number_in(row[1]),
                             .cpu_s = number_in(row[2]),
                             .slam_s = number_in(row[3]),
                             .frames_s = number_in(row[4]),
                             .products_s = number_in(row[5]),
                             .max_rss_mb = number_in(row[6])};
    if (const auto* host = std::get_if<std::string>(&row[7])) source.host_of[*name] = *host;
  }
}

}  // namespace

PagesSource read_source(const fs::path& path) {
  if (!is_there(path)) throw InputError(fmt::format("{}: no such results folder", path.string()));
  PagesSource source;
  source.folder = is_folder(path) ? path : fs::absolute(path).parent_path();
  const fs::path named = fs::absolute(source.folder).lexically_normal();
  source.name = (named.filename().empty() ? named.parent_path() : named).filename().string();
  source.reproduction =
      json_file(source, "reproduction.json",
                {"command", "commit", "code", "build_and_machine", "seeds", "inputs"});
  source.audit = json_file(source, "audit.json", {"rows"});
  if (is_file(source.folder / "audit.csv"))
    source.audit_csv = read_file(source.folder / "audit.csv");
  const fs::path file = is_folder(path) ? path / "results.sqlite" : path;
  if (!is_file(file)) {
    if (source.audit.is_null())
      throw InputError(
          fmt::format("{}: holds neither results.sqlite nor audit.json", source.folder.string()));
    source.problem = "This folder holds an audit and no results.";
    return source;
  }
  try {
    const Store store = Store::open_to_read(file);
    source.suite = store.planned_suite();
    source.results = load_results(store, *source.suite);
    // A store contains no alignments: they are recomputed from the true and the estimated path.
    for (RunResult& run : source.results.runs)
      if (!run.truth.empty() && !run.estimate.empty())
        run.alignment = align_estimate(run.estimate, run.truth);
    read_costs(store, source);
  } catch (const InputError& error) {
    source.suite.reset();
    source.results = {};
    source.problem = printable(error.what());
  }
  return source;
}

std::optional<OccupancyGrid> grid_of(const PagesSource& source, const RunResult& run) {
  if (!run.grid.cells.empty()) return run.grid;
  const std::filesystem::path file = source.folder / run.spec.name / "map.yaml";
  if (source.folder.empty() || !is_file(file)) return std::nullopt;
  try {
    OccupancyGrid grid = load_map_server(file);
    // The folder may contain files of a different run.
    if (digest_bytes(grid.cells.data(), grid.cells.size(), digest(run.estimate)) != run.map_digest)
      return std::nullopt;
    return grid;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace mh
