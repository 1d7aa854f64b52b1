// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <sstream>
#include <tuple>

#include <fmt/format.h>

#include "bench/report/pages/page_table.hpp"
#include "bench/report/pages/tables.hpp"
#include "bench/report/wording.hpp"
#include "bench/suite/parameters.hpp"
#include "slam/config/slam.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

void identify(PageTable& table, const RunSpec& spec, const std::string& status) {
  table.begin_row();
  table.text({"run", "run"}, spec.name);
  table.text({"status", "status"}, status);
  table.text({"environment", "environment"}, spec.environment.name);
  table.text({"category", "category"}, spec.environment.category);
  table.text({"system", "system"}, spec.system.name);
  table.text({"labels", "labels"}, name(spec.labels));
  table.text({"level", "level"}, level_name(spec.level));
  table.number({"trial", "trial"}, spec.trial);
}

/// The title of a run's metric, preceded by the short name of its query set or by "episodes".
std::string metric_title(const Metric& metric) {
  std::string title = metric.heading.empty() ? metric.name : std::string(metric.heading);
  if (metric.name.starts_with("episodes.")) return "episodes: " + title;
  for (const QuerySet set : kQuerySets) {
    const std::string prefix = fmt::format("{}.", name(set));
    if (!metric.name.starts_with(prefix)) continue;
    const std::string own = metric.heading.empty() ? metric.name.substr(prefix.size()) : title;
    return fmt::format("{}: {}", short_title(set), own);
  }
  return title;
}

void put_cost(PageTable& table, const PagesSource& source, const RunResult& run) {
  const auto cost = source.cost_of.find(run.spec.name);
  if (cost != source.cost_of.end()) {
    const RunCost& c = cost->second;
    table.number({"wall_s", "wall time", "s", 1}, c.wall_s);
    table.number({"cpu_s", "CPU time", "s", 1}, c.cpu_s);
    table.number({"slam_s", "CPU: SLAM", "s", 1}, c.slam_s);
    table.number({"frames_s", "CPU: frames", "s", 1}, c.frames_s);
    table.number({"products_s", "CPU: maps, images", "s", 1}, c.products_s);
    table.number({"max_rss_mb", "memory", "MB", 0}, c.max_rss_mb);
  }
  const auto times = [&](const char* key, const char* title, const std::vector<double>& all_ms) {
    if (all_ms.empty()) return;
    const TimeSummary t = summarize(all_ms);
    table.number({fmt::format("{}.median", key), fmt::format("{}, median", title), "ms", 2},
                 t.median_ms);
    table.number({fmt::format("{}.p95", key), fmt::format("{}, 95 %", title), "ms", 2}, t.p95_ms);
  };
  times("track_ms", "track", run.times.track_ms);
  times("relocalize_ms", "relocalize", run.times.relocalize_ms);
  if (const auto host = source.host_of.find(run.spec.name); host != source.host_of.end())
    table.text({"host", "machine"}, host->second);
  if (run.circumstances.jobs > 0)
    table.number({"jobs", "runs side by side"}, run.circumstances.jobs);
}

/// For each query (by run, query set and frame), the first cause of failure that an audit states at
/// the first point.
using Causes = std::map<std::tuple<std::string, std::string, std::string>, std::string>;

/// Cells of a line of CSV; quotes around a cell are removed.
std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line)
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

Causes causes_in(const std::string& csv) {
  Causes causes;
  std::istringstream lines(csv);
  std::string line;
  if (!std::getline(lines, line)) return causes;
  std::map<std::string, std::size_t> place;
  for (const std::string& title : csv_cells(line)) place.emplace(title, place.size());
  for (const char* needed : {"run", "query_set", "frame", "cause"})
    if (!place.contains(needed)) return causes;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() != place.size()) continue;
    causes.try_emplace({cells[place["run"]], cells[place["query_set"]], cells[place["frame"]]},
                       cells[place["cause"]]);
  }
  return causes;
}

/// The settings of a run's points, as the suite's sweep varies them; empty for a single point.
std::vector<std::string> points_of(const PagesSource& source, const RunResult& run) {
  std::vector<std::string> points;
  if (run.points.size() < 2) return points;
  for (const SemanticConfig& point : run.spec.points) {
    SlamConfig at = *run.spec.slam;
    at.semantics = point;
    points.push_back(shown_point(source.suite->sweep, at));
  }
  return points;
}

const char* outcome(const QueryScore& q) {
  return !q.success      ? "unanswered"
         : !is_judged(q) ? "answered, not judged"
         : q.correct     ? "correct"
                         : "false positive";
}

}  // namespace

std::optional<SE3> answer_in_truth(const RunResult& run, QuerySet set, const QueryScore& query) {
  if (!query.answer.world_from_camera) return std::nullopt;
  const auto anchor = find_anchor(mapped_beside(run, query.answer), run.truth,
                                  {query.stamp_ns, query.true_world_from_camera}, nearest_by(set),
                                  run.spec.protocol);
  if (!anchor) return std::nullopt;
  return anchor->truth * anchor->estimate.inverse() * *query.answer.world_from_camera;
}

Json runs_json(const PagesSource& source) {
  const bool sweeps = std::ranges::any_of(
      source.results.runs, [](const RunResult& run) { return run.points.size() > 1; });
  PageTable table("Runs", sweeps ? "Metrics at the first point of the sweep." : "");
  for (const RunResult& run : source.results.runs) {
    identify(table, run.spec, run.mapping.gave_up ? "gave up" : "done");
    if (!run.points.empty())
      for (const Figure& figure : figures_of(run, 0))
        table.number(column_of(figure.metric, metric_title(figure.metric)), figure.value);
    std::size_t keyframes = 0;
    for (const MappedFrame& call : run.mapping.calls) keyframes += call.keyframe_added ? 1 : 0;
    if (!run.mapping.calls.empty())
      table.number({"keyframes_made", "keyframes"}, static_cast<double>(keyframes));
    put_cost(table, source, run);
  }
  for (const FailedRun& run : source.results.failed) {
    identify(table, run.spec, "failed");
    table.text({"error", "error"}, run.error);
  }
  return table.json();
}

Json queries_json(const PagesSource& source, const RunResult* only) {
  PageTable table("Queries",
                  "Distance and angle are measured from the nearest mapped frame, so that a bent "
                  "map is no error of its answers (docs/protocol.md).");
  const Causes causes = causes_in(source.audit_csv);
  for (const RunResult& run : source.results.runs) {
    if (only != nullptr && &run != only) continue;
    const std::vector<std::string> points = points_of(source, run);
    for (std::size_t p = 0; p < run.points.size(); ++p)
      for (const QuerySet set : kQuerySets)
        for (const QueryScore& q : queries(run.points[p], set)) {
          table.begin_row();
          table.text({"run", "run"}, run.spec.name);
          table.text({"environment", "environment"}, run.spec.environment.name);
          table.text({"system", "system"}, run.spec.system.name);
          table.text({"labels", "labels"}, name(run.spec.labels));
          table.text({"level", "level"}, level_name(run.spec.level));
          if (run.points.size() > 1) {
            table.number({"point", "point"}, static_cast<double>(p));
            table.text({"settings", "settings"}, points[p]);
          }
          table.text({"query_set", "queries"}, name(set));
          table.number({"frame", "frame"}, static_cast<double>(q.answer.index));
          table.text({"outcome", "outcome"}, outcome(q));
          if (q.answer.stage) table.text({"stage", "furthest stage"}, name(*q.answer.stage));
          if (p == 0 && !causes.empty()) {
            const auto cause = causes.find(
                {run.spec.name, std::string(name(set)), std::to_string(q.answer.index)});
            if (cause != causes.end()) table.text({"cause", "first cause"}, cause->second);
          }
          table.number({"distance_m", "distance", "m", 4}, q.distance_m);
          table.number({"angle_deg", "angle", "deg", 2}, q.angle_deg);
          table.number({"attempts", "attempts"}, q.answer.attempts);
          const auto whole = [](const std::optional<int>& value) {
            return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
          };
          table.number({"final", "candidates"}, whole(q.answer.candidates.final));
          table.number({"label_mass", "label mass", "%", 1}, q.answer.candidates.label_mass);
          const auto place = [&](const char* key, const std::optional<SE3>& pose, const SE3& to) {
            if (!pose) return;
            const Eigen::Vector3d at = to * pose->translation();
            for (int i = 0; i < 3; ++i)
              table.number({.key = fmt::format("{}_{}", key, "xyz"[i]),
                            .title = fmt::format("{} {}", key, "xyz"[i]),
                            .unit = "m",
                            .decimals = 3,
                            .is_hidden = true},
                           std::round(at[i] * 1e3) / 1e3);
          };
          place("true", q.true_world_from_camera, SE3());
          place("estimated", answer_in_truth(run, set, q), SE3());
        }
  }
  return table.json();
}

}  // namespace mh
