// SPDX-License-Identifier: Apache-2.0
#include "bench/store/result_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "bench/protocol/query_means.hpp"
#include "bench/store/columns.hpp"
#include "bench/store/schema.hpp"
#include "bench/suite/run_key.hpp"
#include "slam/io/error.hpp"
#include "slam/io/json_text.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

/// The fields of a run that have no rows of their own, as stored in `runs.result`.
template <MaybeConst<RunResult> R, class Visit>
void result_fields(R& run, Visit& v) {
  v("place", run.place);
  v("mapping", run.mapping);
  v("trajectory", run.trajectory);
  v("map_digest", as_digest(run.map_digest));
}

Json result_json(const RunResult& run) {
  Json json;
  const auto write = [&](const char* name, const auto& value) { json[name] = json_of(value); };
  result_fields(run, write);
  return json;
}

void read_result(const Json& json, RunResult& run) {
  const auto read = [&](const char* name, auto&& value) { read_json(json.at(name), value); };
  result_fields(run, read);
}

/// How many rows a run has, without the one in `runs`.
std::int64_t row_count(SQLite::Database& db, const std::string& key) {
  std::int64_t count = 0;
  for (const char* table : kTablesOfRuns) {
    SQLite::Statement s(db, fmt::format("SELECT count(*) FROM {} WHERE key = ?", table));
    s.bind(1, key);
    s.executeStep();
    count += s.getColumn(0).getInt64();
  }
  return count;
}

void put_metrics(SQLite::Database& db, const std::string& key, const RunResult& run) {
  RowWriter rows(db, "metrics");
  for (std::size_t p = 0; p < run.points.size(); ++p)
    for (const Figure& figure : figures_of(run, p)) {
      rows << key << p << figure.metric.name << figure.value;
      rows.end_row();
    }
}

void put_points(SQLite::Database& db, const std::string& key, const RunSpec& spec) {
  RowWriter rows(db, "points");
  for (std::size_t p = 0; p < spec.points.size(); ++p) {
    rows << key << p;
    if (spec.system.takes_settings())
      fields(spec.points[p], rows);  // otherwise, the rest is left null
    rows.end_row();
  }
}

void put_calls(SQLite::Database& db, const std::string& key, const RunResult& run) {
  RowWriter rows(db, "calls");
  std::int64_t call = 0;
  for (const MappedFrame& m : run.mapping.calls) {
    rows << key << call++ << m;
    rows.end_row();
  }
}

void put_frames(SQLite::Database& db, const std::string& key, const RunResult& run) {
  RowWriter rows(db, "frames");
  std::map<Stamp, FrameRow> row_of;
  for (const TimedPose& pose : run.truth) row_of[pose.stamp_ns].truth = pose.world_from_camera;
  for (const Trajectory* poses : {&run.estimate, &run.elsewhere})
    for (const TimedPose& pose : *poses) {
      FrameRow& row = row_of[pose.stamp_ns];
      row.estimate = pose.world_from_camera;
      row.map = pose.map;
    }
  std::int64_t frame = 0;
  for (auto& [stamp_ns, row] : row_of) {
    row.stamp_ns = stamp_ns;
    row.frame = frame++;
    rows << key << row;
    rows.end_row();
  }
}

void put_queries(SQLite::Database& db, const std::string& key, const RunResult& run) {
  RowWriter rows(db, "queries");
  for (std::size_t p = 0; p < run.points.size(); ++p)
    for (const QuerySet set : kQuerySets)
      for (const QueryScore& q : queries(run.points[p], set)) {
        rows << key << p << name(set) << q;
        rows.end_row();
      }
}

void put_episodes(SQLite::Database& db, const std::string& key, const RunResult& run) {
  RowWriter rows(db, "episodes");
  for (std::size_t i = 0; i < run.episodes.size(); ++i) {
    rows << key << i << run.episodes[i];
    rows.end_row();
  }
}

void load_calls(SQLite::Database& db, const std::string& key, RunResult& run) {
  SQLite::Statement s(db, "SELECT * FROM calls WHERE key = ? ORDER BY call");
  s.bind(1, key);
  while (s.executeStep()) {
    RowReader reader(s, 2);  // after key and call
    fields(run.mapping.calls.emplace_back(), reader);
  }
}

void load_frames(SQLite::Database& db, const std::string& key, RunResult& run) {
  SQLite::Statement s(db, "SELECT * FROM frames WHERE key = ? ORDER BY frame");
  s.bind(1, key);
  Trajectory all;
  while (s.executeStep()) {
    RowReader reader(s, 1);  // after key
    FrameRow row;
    fields(row, reader);
    if (row.truth) run.truth.push_back({row.stamp_ns, *row.truth});
    if (row.estimate) all.push_back({row.stamp_ns, *row.estimate, row.map});
  }
  set_estimate(run, all);
}

void load_queries(SQLite::Database& db, const std::string& key, RunResult& run) {
  SQLite::Statement s(
      db, "SELECT * FROM queries WHERE key = ? AND point = ? AND query_set = ? ORDER BY frame");
  run.points.resize(run.spec.points.size());
  for (std::size_t p = 0; p < run.points.size(); ++p)
    for (const QuerySet set : kQuerySets) {
      auto& list = of_query_set(run.points[p], set);
      s.bind(1, key);
      s.bind(2, static_cast<std::int64_t>(p));
      s.bind(3, std::string(name(set)));
      while (s.executeStep()) {
        RowReader reader(s, 3);  // after key, point and query_set
        fields(list.emplace_back(), reader);
      }
      s.reset();
    }
}

void load_episodes(SQLite::Database& db, const std::string& key, RunResult& run) {
  SQLite::Statement s(db, "SELECT * FROM episodes WHERE key = ? ORDER BY episode");
  s.bind(1, key);
  while (s.executeStep()) {
    RowReader reader(s, 2);  // after key and episode
    fields(run.episodes.emplace_back(), reader);
  }
}

void load_times(SQLite::Database& db, const std::string& key, RunResult& run) {
  SQLite::Statement s(
      db, "SELECT wall_s, calls, host, session_start, jobs, load FROM times WHERE key = ?");
  s.bind(1, key);
  if (!s.executeStep()) return;
  run.wall_s = s.getColumn(0).getDouble();
  run.circumstances = {.host = s.getColumn(2).getString(),
                       .session_start = s.getColumn(3).getString(),  // null becomes empty
                       .jobs = s.getColumn(4).getInt(),
                       .load = s.getColumn(5).getDouble()};
  const Json calls = parse_json_or_discard<Json>(s.getColumn(1).getString());
  if (!calls.is_object()) return;
  run.times.track_ms = calls.value("track_ms", std::vector<double>());
  run.times.relocalize_ms = calls.value("relocalize_ms", std::vector<double>());
  run.times.blank_ms = calls.value("blank_ms", std::vector<double>());
}

}  // namespace

Json calls_json(const CallTimes& times) {
  const auto rounded = [](const std::vector<double>& all) {
    Json list = Json::array();
    for (const double ms : all) list.push_back(std::round(ms * 1e3) / 1e3);
    return list;
  };
  return {{"track_ms", rounded(times.track_ms)},
          {"relocalize_ms", rounded(times.relocalize_ms)},
          {"blank_ms", rounded(times.blank_ms)}};
}

void put_run(SQLite::Database& db, const std::string& key, const RunSpec& spec,
             const std::string& error, const std::string& result) {
  RowWriter row(db, "runs");
  row << key << spec.name << spec.environment.name << spec.environment.category
      << level_name(spec.level) << spec.system.name << name(spec.labels) << spec.trial << spec.seed
      << (error.empty() ? "done" : "failed") << error << stored_spec(spec) << result
      << row_count(db, key);
  row.end_row();
}

void put_rows(SQLite::Database& db, const std::string& key, const RunResult& run) {
  put_points(db, key, run.spec);
  put_metrics(db, key, run);
  put_calls(db, key, run);
  put_frames(db, key, run);
  put_queries(db, key, run);
  put_episodes(db, key, run);
  put_run(db, key, run.spec, "", result_json(run).dump());
}

void forget_rows(SQLite::Database& db, const std::string& key) {
  const auto forget = [&](const char* table) {
    SQLite::Statement s(db, fmt::format("DELETE FROM {} WHERE key = ?", table));
    s.bind(1, key);
    s.exec();
  };
  forget("runs");
  std::ranges::for_each(kTablesOfRuns, forget);
}

RunResult load_rows(SQLite::Database& db, const std::filesystem::path& file, const std::string& key,
                    const RunSpec& spec) {
  RunResult run;
  run.spec = spec;
  SQLite::Statement s(db, "SELECT result FROM runs WHERE key = ? AND status = 'done'");
  s.bind(1, key);
  if (!s.executeStep())
    throw InputError(fmt::format("{}: run '{}' is not in it", file.string(), spec.name));
  const auto refuse = [&](const std::string& what) {
    throw InputError(
        fmt::format("{}: run '{}' is damaged: {}: put back a copy, or move the file away "
                    "and run again",
                    file.string(), spec.name, what));
  };
  try {
    read_result(parse_json<Json>(s.getColumn(0).getString()), run);
    load_calls(db, key, run);
    load_frames(db, key, run);
    load_queries(db, key, run);
    load_episodes(db, key, run);
    load_times(db, key, run);
  } catch (const Json::exception& error) {
    refuse(json_fault(error));
  } catch (const InputError& error) {
    refuse(error.what());
  }
  return run;
}

}  // namespace mh
