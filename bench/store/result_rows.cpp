// SPDX-License-Identifier: Apache-2.0
#include "bench/store/result_rows.hpp"

#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <map>

#include <fmt/format.h>

#include "bench/inputs/run_key.hpp"
#include "bench/plan/spec_json.hpp"
#include "bench/provenance/digest.hpp"
#include "bench/results/summary.hpp"
#include "bench/store/row_digest.hpp"
#include "slam/core/error.hpp"
#include "slam/core/settings_io.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

// ---- scalars ---------------------------------------------------------------------------------

std::uint64_t from_hex(const std::string& text) {
  return std::strtoull(text.c_str(), nullptr, 16);
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}
Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}
double number_or_nan(const Json& json) {
  return json.is_null() ? std::nan("") : json.get<double>();
}
std::optional<double> known_number(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

template <class T>
T named(const std::string& word, std::initializer_list<T> values) {
  for (const T value : values)
    if (name(value) == word) return value;
  throw InputError(fmt::format("results file: '{}' is no known word", word));
}

// ---- statements ------------------------------------------------------------------------------

/// Binds one value after another.
class Insert {
 public:
  Insert(SQLite::Database& db, const std::string& table, int columns)
      : statement_(db, insert_row(table, columns)) {}
  Insert& operator<<(const std::string& text) {
    statement_.bind(next_++, text);
    return *this;
  }
  Insert& operator<<(std::string_view text) { return *this << std::string(text); }
  Insert& operator<<(const std::optional<std::string>& text) {
    if (text) return *this << *text;
    ++next_;  // stays null
    return *this;
  }
  Insert& operator<<(std::int64_t value) {
    statement_.bind(next_++, value);
    return *this;
  }
  Insert& operator<<(double value) {
    std::isfinite(value) ? statement_.bind(next_, value) : statement_.bind(next_);
    ++next_;
    return *this;
  }
  Insert& operator<<(const std::optional<double>& value) {
    return *this << (value ? *value : std::nan(""));
  }
  Insert& operator<<(const SE3& pose) {
    const Eigen::Vector3d& t = pose.translation();
    const Eigen::Quaterniond q = pose.quaternion();
    for (const double v : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) *this << v;
    return *this;
  }
  Insert& operator<<(const std::optional<SE3>& pose) {
    if (pose) return *this << *pose;
    next_ += 7;  // stay null
    return *this;
  }
  void put() {
    statement_.exec();
    statement_.reset();
    statement_.clearBindings();
    next_ = 1;
  }

 private:
  SQLite::Statement statement_;
  int next_ = 1;
};

SE3 pose_at(SQLite::Statement& s, int column) {
  const auto v = [&](int i) { return s.getColumn(column + i).getDouble(); };
  return {Eigen::Quaterniond(v(6), v(3), v(4), v(5)), Eigen::Vector3d(v(0), v(1), v(2))};
}

// ---- the parts that are no rows of their own -------------------------------------------------

Json matches_json(const MatchCounts& matches) {
  Json all = Json::array();
  for (const MatcherCounts& c : matches)
    all.push_back({c.compared, c.penalized, c.rejected_by_xi, c.ratio_helped});
  return all;
}

MatchCounts matches_from_json(const Json& json) {
  MatchCounts matches{};
  for (std::size_t m = 0; m < matches.size() && m < json.size(); ++m)
    matches[m] = {json[m][0], json[m][1], json[m][2], json[m][3]};
  return matches;
}

Json path_json(const PathFacts& p) {
  return {p.frames, number(p.length_m), number(p.turned_in_place_rad), number(p.contact_time_s),
          number(p.max_penetration_m)};
}

PathFacts path_from_json(const Json& p) {
  return {p[0], number_or_nan(p[1]), number_or_nan(p[2]), number_or_nan(p[3]), number_or_nan(p[4])};
}

Json place_json(const PlaceFacts& p) {
  Json inputs = Json::array();
  for (const InputDigest& input : p.inputs) {
    Json files = Json::array();
    for (const FileDigest& file : input.files) files.push_back({file.file, hex(file.digest)});
    inputs.push_back({input.name, hex(input.digest), files});
  }
  return {{"scene", p.scene},
          {"robot", p.robot},
          {"scene_digest", hex(p.scene_digest)},
          {"path_digest", hex(p.path_digest)},
          {"vocabulary_digest", hex(p.vocabulary_digest)},
          {"vocabulary_words", p.vocabulary_words},
          {"mapping", path_json(p.mapping)},
          {"second", p.second ? path_json(*p.second) : Json()},
          {"cut", p.cut},
          {"inputs", inputs}};
}

PlaceFacts place_from_json(const Json& p) {
  PlaceFacts place{.scene = p.at("scene"),
                   .robot = p.at("robot"),
                   .scene_digest = from_hex(p.at("scene_digest")),
                   .path_digest = from_hex(p.at("path_digest")),
                   .vocabulary_digest = from_hex(p.at("vocabulary_digest")),
                   .vocabulary_words = p.at("vocabulary_words"),
                   .mapping = path_from_json(p.at("mapping")),
                   .second = {},
                   .cut = p.at("cut"),
                   .inputs = {}};
  if (!p.at("second").is_null()) place.second = path_from_json(p.at("second"));
  for (const Json& input : p.at("inputs")) {
    place.inputs.push_back({input[0], from_hex(input[1])});
    if (input.size() < 3) continue;  // of an older version, which kept no list of files
    for (const Json& file : input[2])
      place.inputs.back().files.push_back({file[0], from_hex(file[1])});
  }
  return place;
}

Json loops_json(const std::vector<LoopClosure>& loops) {
  Json all = Json::array();
  for (const LoopClosure& loop : loops) {
    const Eigen::Vector3d& t = loop.old_from_new.translation();
    const Eigen::Quaterniond q = loop.old_from_new.quaternion();
    all.push_back(
        {loop.stamp_ns, loop.old_stamp_ns, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
  }
  return all;
}

std::vector<LoopClosure> loops_from_json(const Json& json) {
  std::vector<LoopClosure> loops;
  for (const Json& l : json)
    loops.push_back(
        {l[0], l[1],
         SE3(Eigen::Quaterniond(l[8], l[5], l[6], l[7]), Eigen::Vector3d(l[2], l[3], l[4]))});
  return loops;
}

Json result_json(const RunResult& run) {
  const MappingOutcome& m = run.mapping;
  const TrajectoryScore& t = run.trajectory;
  Json json = {{"place", place_json(run.place)},
               {"mapping",
                {{"dropped", m.dropped},
                 {"failures", m.failures},
                 {"restarts", m.restarts},
                 {"before_map", m.before_map},
                 {"gave_up", m.gave_up},
                 {"offered", m.offered},
                 {"loops", loops_json(m.loops)},
                 {"matches", matches_json(m.matches)}}},
               {"trajectory",
                {{"offered", t.offered},
                 {"tracked", t.tracked},
                 {"completeness", t.completeness},
                 {"ate_rmse_m", number(t.ate_rmse_m)},
                 {"ate_first_pose_m", number(t.ate_first_pose_m)},
                 {"rpe_frame_rmse_m", number(t.rpe_frame_rmse_m)},
                 {"rpe_second_rmse_m", number(t.rpe_second_rmse_m)}}},
               {"map_digest", hex(run.map_digest)}};
  if (m.skipped.count > 0)
    json["mapping"]["skipped"] = {{"count", m.skipped.count}, {"reasons", m.skipped.reasons}};
  return json;
}

void read_result(const Json& json, RunResult& run) {
  run.place = place_from_json(json.at("place"));
  run.map_digest = from_hex(json.at("map_digest"));
  const Json& m = json.at("mapping");
  run.mapping.dropped = m.at("dropped").get<std::vector<std::size_t>>();
  run.mapping.failures = m.at("failures");
  run.mapping.restarts = m.at("restarts");
  run.mapping.before_map = m.at("before_map");
  run.mapping.gave_up = m.at("gave_up");
  run.mapping.offered = m.at("offered");
  run.mapping.loops = loops_from_json(m.at("loops"));
  run.mapping.matches = matches_from_json(m.at("matches"));
  if (m.contains("skipped"))
    run.mapping.skipped = {m.at("skipped").at("count"), m.at("skipped").at("reasons")};
  const Json& t = json.at("trajectory");
  run.trajectory.offered = t.at("offered");
  run.trajectory.tracked = t.at("tracked");
  run.trajectory.completeness = t.at("completeness");
  run.trajectory.ate_rmse_m = known_number(t.at("ate_rmse_m"));
  run.trajectory.ate_first_pose_m = known_number(t.at("ate_first_pose_m"));
  run.trajectory.rpe_frame_rmse_m = known_number(t.at("rpe_frame_rmse_m"));
  run.trajectory.rpe_second_rmse_m = known_number(t.at("rpe_second_rmse_m"));
}

// ---- rows ------------------------------------------------------------------------------------

void put_metrics(SQLite::Database& db, const std::string& key, const RunResult& run) {
  Insert row(db, "metrics", 4);
  for (std::size_t p = 0; p < run.points.size(); ++p) {
    const auto put = [&](const std::string& what, const std::optional<double>& value) {
      row << key << static_cast<std::int64_t>(p) << what << value;
      row.put();
    };
    const TrajectoryScore& t = run.trajectory;
    put("ate_rmse_m", t.ate_rmse_m);
    put("ate_first_pose_m", t.ate_first_pose_m);
    put("rpe_frame_rmse_m", t.rpe_frame_rmse_m);
    put("rpe_second_rmse_m", t.rpe_second_rmse_m);
    put("completeness", t.completeness);
    put("restarts", run.mapping.restarts);
    put("dropped", static_cast<double>(run.mapping.dropped.size()));
    for (const QuerySet set : kQuerySets) {
      const QuerySummary s = summarize(queries(run.points[p], set));
      if (s.queries == 0) continue;
      const std::string prefix = std::string(name(set)) + ".";
      put(prefix + "queries", s.queries);
      put(prefix + "success", s.success);
      put(prefix + "correct", s.correct);
      put(prefix + "false", s.wrong);
      put(prefix + "distance_mean_m", s.distance_mean_m);
      put(prefix + "distance_median_m", s.distance_median_m);
      put(prefix + "candidates", s.final);
      put(prefix + "label_mass", s.label_mass);
    }
  }
}

void put_calls(SQLite::Database& db, const std::string& key, const RunResult& run) {
  Insert row(db, "calls", 11);
  std::int64_t call = 0;
  for (const MappedFrame& m : run.mapping.calls) {
    row << key << call++ << static_cast<std::int64_t>(m.index) << m.stamp_ns
        << std::int64_t{m.restart} << name(m.status)
        << (m.inliers == kUnknownCount ? std::nullopt : std::optional<double>(m.inliers))
        << std::int64_t{m.keyframe_added} << hex(m.image_digest) << hex(m.matching_digest)
        << hex(m.pose_digest);
    row.put();
  }
}

void put_frames(SQLite::Database& db, const std::string& key, const RunResult& run) {
  Insert row(db, "frames", 17);
  // A recording's truth may have other stamps than its frames, or be unknown: one row per moment.
  auto truth = run.truth.begin(), estimate = run.estimate.begin();
  const auto take = [](auto& next, auto end, Stamp stamp_ns) {
    return next != end && next->stamp_ns == stamp_ns ? std::optional(next++->world_from_camera)
                                                     : std::nullopt;
  };
  for (std::int64_t frame = 0; truth != run.truth.end() || estimate != run.estimate.end();
       ++frame) {
    const bool estimate_first = truth == run.truth.end() || (estimate != run.estimate.end() &&
                                                             estimate->stamp_ns < truth->stamp_ns);
    const Stamp stamp_ns = estimate_first ? estimate->stamp_ns : truth->stamp_ns;
    row << key << frame << stamp_ns << take(truth, run.truth.end(), stamp_ns)
        << take(estimate, run.estimate.end(), stamp_ns);
    row.put();
  }
}

void put_queries(SQLite::Database& db, const std::string& key, const RunResult& run) {
  Insert row(db, "queries", 38);
  const SystemSpec& system = run.spec.system;
  for (std::size_t p = 0; p < run.points.size(); ++p)
    for (const QuerySet set : kQuerySets)
      for (const QueryScore& q : queries(run.points[p], set)) {
        const auto& c = q.answer.candidates;
        const auto counted = [&](int CandidateCounts::*count) {
          return c && (*c).*count != kUnknownCount ? std::optional<double>((*c).*count)
                                                   : std::nullopt;
        };
        const auto told = [](bool is, std::string_view text) {
          return is ? std::optional(std::string(text)) : std::nullopt;
        };
        row << key << static_cast<std::int64_t>(p) << name(set)
            << static_cast<std::int64_t>(q.answer.index) << q.stamp_ns << std::int64_t{q.success}
            << std::int64_t{q.correct} << std::int64_t{q.wrong}
            << told(reports_stage(system, q.answer.stage), name(q.answer.stage))
            << std::int64_t{q.answer.attempts} << std::int64_t{q.answer.blank_frames}
            << q.distance_m << q.angle_deg << q.aligned_distance_m
            << counted(&CandidateCounts::keyframes) << counted(&CandidateCounts::c1)
            << counted(&CandidateCounts::c2) << counted(&CandidateCounts::c3)
            << counted(&CandidateCounts::final) << (c ? std::optional(c->label_mass) : std::nullopt)
            << q.true_world_from_camera << q.answer.world_from_camera << hex(q.answer.image_digest)
            << hex(q.answer.matching_digest) << hex(q.answer.pose_digest)
            << told(system.takes_settings(), matches_json(q.answer.matches).dump());
        row.put();
      }
}

QueryScore query_at(SQLite::Statement& s) {
  // Columns of `queries` from `frame` on.
  const auto integer = [&](int i) { return s.getColumn(i).getInt(); };
  const auto known = [&](int i) {
    return s.getColumn(i).isNull() ? std::nullopt : std::optional(s.getColumn(i).getDouble());
  };
  QueryScore q;
  q.answer.index = static_cast<std::size_t>(s.getColumn(0).getInt64());
  q.stamp_ns = s.getColumn(1).getInt64();
  q.success = integer(2) != 0;
  q.correct = integer(3) != 0;
  q.wrong = integer(4) != 0;
  if (!s.getColumn(5).isNull())
    q.answer.stage = named(s.getColumn(5).getString(),
                           {RelocalizationStage::kNone, RelocalizationStage::kNoCandidate,
                            RelocalizationStage::kMatches, RelocalizationStage::kPnp,
                            RelocalizationStage::kInliers, RelocalizationStage::kVerified});
  q.answer.attempts = integer(6);
  q.answer.blank_frames = integer(7);
  q.distance_m = known(8);
  q.angle_deg = known(9);
  q.aligned_distance_m = known(10);
  const auto count = [&](int i) { return s.getColumn(i).isNull() ? kUnknownCount : integer(i); };
  const CandidateCounts told{.keyframes = count(11),
                             .c1 = count(12),
                             .c2 = count(13),
                             .c3 = count(14),
                             .final = count(15),
                             .label_mass = known(16).value_or(std::nan(""))};
  for (const int number : {told.keyframes, told.c1, told.c2, told.c3, told.final})
    if (number != kUnknownCount) q.answer.candidates = told;
  if (!s.getColumn(17).isNull()) q.true_world_from_camera = pose_at(s, 17);
  if (!s.getColumn(24).isNull()) q.answer.world_from_camera = pose_at(s, 24);
  q.answer.image_digest = from_hex(s.getColumn(31).getString());
  q.answer.matching_digest = from_hex(s.getColumn(32).getString());
  q.answer.pose_digest = from_hex(s.getColumn(33).getString());
  if (!s.getColumn(34).isNull())
    q.answer.matches = matches_from_json(Json::parse(s.getColumn(34).getString()));
  return q;
}

void load_calls(SQLite::Database& db, const std::string& key, RunResult& run) {
  SQLite::Statement s(
      db,
      "SELECT frame, stamp_ns, restart, status, inliers, keyframe, image, matching, "
      "pose FROM calls WHERE key = ? ORDER BY call");
  s.bind(1, key);
  while (s.executeStep())
    run.mapping.calls.push_back(
        {.index = static_cast<std::size_t>(s.getColumn(0).getInt64()),
         .stamp_ns = s.getColumn(1).getInt64(),
         .restart = s.getColumn(2).getInt(),
         .status =
             named(s.getColumn(3).getString(), {TrackStatus::kInitialized, TrackStatus::kTracked,
                                                TrackStatus::kRelocalized, TrackStatus::kLost}),
         .inliers = s.getColumn(4).isNull() ? kUnknownCount : s.getColumn(4).getInt(),
         .keyframe_added = s.getColumn(5).getInt() != 0,
         .image_digest = from_hex(s.getColumn(6).getString()),
         .matching_digest = from_hex(s.getColumn(7).getString()),
         .pose_digest = from_hex(s.getColumn(8).getString())});
}

void load_frames(SQLite::Database& db, const std::string& key, RunResult& run) {
  SQLite::Statement s(db, "SELECT * FROM frames WHERE key = ? ORDER BY frame");
  s.bind(1, key);
  while (s.executeStep()) {
    const Stamp stamp_ns = s.getColumn(2).getInt64();
    if (!s.getColumn(3).isNull()) run.truth.push_back({stamp_ns, pose_at(s, 3)});
    if (!s.getColumn(10).isNull()) run.estimate.push_back({stamp_ns, pose_at(s, 10)});
  }
}

void load_queries(SQLite::Database& db, const std::string& key, RunResult& run) {
  SQLite::Statement s(
      db,
      "SELECT frame, stamp_ns, success, correct, wrong, stage, attempts, blank_frames, distance_m, "
      "angle_deg, aligned_distance_m, keyframes, c1, c2, c3, final, label_mass, "
      "true_tx, true_ty, true_tz, true_qx, true_qy, true_qz, true_qw, tx, ty, tz, qx, qy, qz, qw, "
      "image, matching, pose, matchers FROM queries "
      "WHERE key = ? AND point = ? AND query_set = ? ORDER BY frame");
  run.points.resize(run.spec.points.size());
  for (std::size_t p = 0; p < run.points.size(); ++p)
    for (const QuerySet set : kQuerySets) {
      auto& list = set == QuerySet::kHeldOut ? run.points[p].held_out : run.points[p].second_tour;
      s.bind(1, key);
      s.bind(2, static_cast<std::int64_t>(p));
      s.bind(3, std::string(name(set)));
      while (s.executeStep()) list.push_back(query_at(s));
      s.reset();
    }
}

void load_times(SQLite::Database& db, const std::string& key, RunResult& run) {
  SQLite::Statement s(db,
                      "SELECT wall_s, calls, host, sitting, jobs, load FROM times WHERE key = ?");
  s.bind(1, key);
  if (!s.executeStep()) return;
  run.wall_s = s.getColumn(0).getDouble();
  run.circumstances = {.host = s.getColumn(2).getString(),
                       .sitting = s.getColumn(3).getString(),  // of null: empty
                       .jobs = s.getColumn(4).getInt(),
                       .load = s.getColumn(5).getDouble()};
  const Json calls = Json::parse(s.getColumn(1).getString(), nullptr, false);
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
  Insert row(db, "runs", 13);
  row << key << spec.name << spec.environment.name << spec.environment.category
      << level_name(spec.level) << spec.system.name << name(spec.labels) << std::int64_t{spec.trial}
      << static_cast<std::int64_t>(spec.seed) << std::string(error.empty() ? "done" : "failed")
      << error << stored_spec(spec) << result;
  row.put();
}

void put_rows(SQLite::Database& db, const std::string& key, const RunResult& run) {
  put_run(db, key, run.spec, "", result_json(run).dump());
  Insert row(db, "points", 8);
  for (std::size_t p = 0; p < run.spec.points.size(); ++p) {
    const SemanticConfig& s = run.spec.points[p];
    row << key << static_cast<std::int64_t>(p);
    // An outside program has no such settings: the rest stays null.
    if (!run.spec.system.is_program())
      row << s.gamma << s.xi << s.alpha << s.beta << SettingsWriter::word_of(s.overlap)
          << std::int64_t{s.void_is_a_label};
    row.put();
  }
  put_metrics(db, key, run);
  put_calls(db, key, run);
  put_frames(db, key, run);
  put_queries(db, key, run);
}

void forget_rows(SQLite::Database& db, const std::string& key) {
  for (const char* table : {"runs", "points", "metrics", "calls", "frames", "queries", "times"}) {
    SQLite::Statement s(db, fmt::format("DELETE FROM {} WHERE key = ?", table));
    s.bind(1, key);
    s.exec();
  }
}

RunResult load_rows(SQLite::Database& db, const std::filesystem::path& file, const std::string& key,
                    const RunSpec& spec) {
  RunResult run;
  run.spec = spec;
  SQLite::Statement s(db, "SELECT result FROM runs WHERE key = ? AND status = 'done'");
  s.bind(1, key);
  if (!s.executeStep())
    throw InputError(fmt::format("{}: run '{}' is not in it", file.string(), spec.name));
  try {
    read_result(Json::parse(s.getColumn(0).getString()), run);
    load_calls(db, key, run);
    load_frames(db, key, run);
    load_queries(db, key, run);
    load_times(db, key, run);
  } catch (const Json::exception& error) {
    throw InputError(
        fmt::format("{}: run '{}' is damaged: {}: put back a copy, or move the file away "
                    "and run again",
                    file.string(), spec.name, error.what()));
  }
  return run;
}

}  // namespace mh
