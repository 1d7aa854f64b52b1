// SPDX-License-Identifier: Apache-2.0
#include "bench/store/store.hpp"

#include <unistd.h>

#include <charconv>
#include <chrono>
#include <ctime>
#include <fstream>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/store/database.hpp"
#include "bench/store/guard.hpp"
#include "bench/store/result_rows.hpp"
#include "bench/store/row_digest.hpp"
#include "bench/suite/fingerprint.hpp"
#include "bench/suite/json_fields.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/json_number.hpp"
#include "slam/io/json_text.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

std::int64_t now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string host() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

/// Start time of a process, in clock ticks since boot; 0 if it does not exist. Together with the
/// process id, this identifies a process, since ids are reused.
std::int64_t start_of_process(std::int64_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const auto after_name = text.rfind(')');
  if (after_name == std::string::npos) return 0;
  std::istringstream fields(text.substr(after_name + 2));
  std::string field;
  for (int i = 0; i < 20; ++i) fields >> field;  // the 22nd field of the line
  return fields ? std::strtoll(field.c_str(), nullptr, 10) : 0;
}

void put_cost(SQLite::Database& db, const std::string& key, const RunCost& cost,
              const std::string& calls) {
  SQLite::Statement s(db, insert_row("times", 14, "INSERT OR REPLACE"));
  s.bind(1, key);
  s.bind(2, cost.wall_s);
  s.bind(3, cost.cpu_s);
  s.bind(4, cost.slam_s);
  s.bind(5, cost.frames_s);
  s.bind(6, cost.max_rss_mb);
  s.bind(7, host());
  s.bind(8, utc_now());
  s.bind(9, fingerprint_json().dump());
  s.bind(10, calls);
  s.bind(11, cost.products_s);
  if (const Circumstances& c = cost.circumstances; !c.session_start.empty()) {
    s.bind(12, c.session_start);
    s.bind(13, c.jobs);
    s.bind(14, c.load);
  }
  s.exec();
}

void end_claim(SQLite::Database& db, const std::string& key) {
  SQLite::Statement s(db, "DELETE FROM claims WHERE key = ?");
  s.bind(1, key);
  s.exec();
}

nlohmann::ordered_json to_json(const SuiteOverrides& o) {
  nlohmann::ordered_json json = {
      {"scene", o.scene ? nlohmann::ordered_json(fs::absolute(*o.scene).string())
                        : nlohmann::ordered_json()},
      {"trials", o.trials ? nlohmann::ordered_json(*o.trials) : nlohmann::ordered_json()},
      {"frames", o.max_frames ? nlohmann::ordered_json(*o.max_frames) : nlohmann::ordered_json()}};
  if (o.frame != SceneFrame{}) json["scene_frame"] = json_of(o.frame);
  if (!o.set.empty()) json["set"] = o.set;
  if (!o.vary.empty()) json["vary"] = o.vary;
  for (const auto& [pattern, found] : o.found)
    for (const FoundRecording& recording : found)
      json["found"][pattern].push_back({recording.sequence, recording.scene_type});
  return json;
}

SuiteOverrides overrides_from_json(const nlohmann::json& json) {
  SuiteOverrides o;
  if (!json.at("scene").is_null()) o.scene = json.at("scene").get<std::string>();
  if (!json.at("trials").is_null()) o.trials = whole_number<int>(json.at("trials"));
  if (!json.at("frames").is_null()) o.max_frames = whole_number<std::size_t>(json.at("frames"));
  if (json.contains("scene_frame")) read_json(json.at("scene_frame"), o.frame);
  if (json.contains("set")) o.set = json.at("set");
  if (json.contains("vary")) o.vary = json.at("vary");
  if (json.contains("found"))
    for (const auto& [pattern, found] : json.at("found").items())
      for (const auto& recording : found)
        o.found[pattern].push_back({recording.at(0), recording.at(1)});
  return o;
}

std::string place_of(const Suite& suite) {
  return fs::absolute(suite.file).lexically_normal().string();
}

std::string stored_overrides(const Suite& suite, SuiteOverrides overrides) {
  overrides.found = suite.found;  // may be read on a machine without the recordings
  return to_json(overrides).dump();
}

}  // namespace

Store::Store(fs::path file) : file_(std::move(file)) {
  guarded(file_, [&] { database_ = open_to_write(file_); });
}
Store::Store() = default;
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;

Store Store::open_to_read(const fs::path& file) {
  const fs::path found = fs::is_directory(file) ? file / "results.sqlite" : file;
  if (!fs::is_regular_file(found))
    throw InputError(fmt::format("{}: cannot be read: no such results file", found.string()));
  require_readable(found);
  Store store;
  store.file_ = found;
  guarded(found, [&] {
    UnchangedFile opened = open_unchanged(found);
    store.opened_ = std::move(opened.name);
    store.copy_ = std::move(opened.copy);
    store.database_ = std::move(opened.database);
  });
  return store;
}

void Store::check() const {
  guarded(file_, [&] { require_whole_rows(*database_, file_); });
}

void Store::plan(const Suite& suite, const SuiteOverrides& overrides,
                 const PlannedKeys& key_of_name) {
  guarded(file_, [&] {
    SQLite::Transaction transaction = begin_writing(*database_);
    SQLite::Statement s(*database_, insert_row("suite", 6, "INSERT OR REPLACE"));
    s.bind(1, 1);
    s.bind(2, suite.name);
    s.bind(3, place_of(suite));
    s.bind(4, suite.text);
    s.bind(5, stored_overrides(suite, overrides));
    s.bind(6, static_cast<std::int64_t>(key_of_name.size()));
    s.exec();
    database_->exec("DELETE FROM plan");
    SQLite::Statement row(*database_, insert_row("plan", 3));
    int position = 0;
    for (const auto& [name, key] : key_of_name) {
      row.bind(1, position++);
      row.bind(2, name);
      row.bind(3, key);
      row.exec();
      row.reset();
    }
    transaction.commit();
  });
}

Suite Store::planned_suite() const {
  return guarded(file_, [&] {
    SQLite::Statement s(*database_, "SELECT file, content, overrides FROM suite");
    if (!s.executeStep())
      throw InputError(fmt::format("{}: holds no suite: run `modelhouse bench` into its folder",
                                   file_.string()));
    return parse_suite(s.getColumn(1).getString(), s.getColumn(0).getString(),
                       overrides_from_json(parse_json<nlohmann::json>(s.getColumn(2).getString())),
                       false);  // the results may be from another machine
  });
}

bool Store::is_planned(const Suite& suite, const SuiteOverrides& overrides,
                       const PlannedKeys& key_of_name) const {
  return guarded(file_, [&] {
    SQLite::Statement s(*database_, "SELECT file, content, overrides FROM suite");
    return s.executeStep() && s.getColumn(0).getString() == place_of(suite) &&
           s.getColumn(1).getString() == suite.text &&
           s.getColumn(2).getString() == stored_overrides(suite, overrides) &&
           planned_keys() == key_of_name;
  });
}

PlannedKeys Store::planned_keys() const {
  return guarded(file_, [&] {
    PlannedKeys keys;
    SQLite::Statement s(*database_, "SELECT name, key FROM plan ORDER BY position");
    while (s.executeStep())
      keys.emplace_back(s.getColumn(0).getString(), s.getColumn(1).getString());
    return keys;
  });
}

std::optional<RunStatus> Store::status(const std::string& key) const {
  return guarded(file_, [&]() -> std::optional<RunStatus> {
    SQLite::Statement s(*database_, "SELECT status FROM runs WHERE key = ?");
    s.bind(1, key);
    if (!s.executeStep()) return std::nullopt;
    return s.getColumn(0).getString() == "done" ? RunStatus::kDone : RunStatus::kFailed;
  });
}

std::string Store::error(const std::string& key) const {
  return guarded(file_, [&]() -> std::string {
    SQLite::Statement s(*database_, "SELECT error FROM runs WHERE key = ?");
    s.bind(1, key);
    return s.executeStep() ? s.getColumn(0).getString() : "";
  });
}

bool Store::claim(const std::string& key) {
  return guarded(file_, [&] {
    SQLite::Transaction transaction = begin_writing(*database_);
    if (status(key)) return false;
    SQLite::Statement s(*database_,
                        "SELECT host, process, started, beat FROM claims WHERE key = ?");
    s.bind(1, key);
    if (s.executeStep()) {
      const bool here = s.getColumn(0).getString() == host();
      const std::int64_t process = s.getColumn(1).getInt64();
      const bool alive = here ? start_of_process(process) == s.getColumn(2).getInt64()
                              : now_s() - s.getColumn(3).getInt64() < kClaimLife_s;
      if (alive) return false;
    }
    s.reset();
    SQLite::Statement insert(*database_, "INSERT OR REPLACE INTO claims VALUES (?, ?, ?, ?, ?)");
    insert.bind(1, key);
    insert.bind(2, host());
    insert.bind(3, static_cast<std::int64_t>(getpid()));
    insert.bind(4, start_of_process(getpid()));
    insert.bind(5, now_s());
    insert.exec();
    transaction.commit();
    return true;
  });
}

void Store::release(const std::string& key) {
  guarded(file_, [&] { end_claim(*database_, key); });
}

void Store::beat() {
  guarded(file_, [&] {
    SQLite::Statement s(*database_, "UPDATE claims SET beat = ? WHERE host = ? AND process = ?");
    s.bind(1, now_s());
    s.bind(2, host());
    s.bind(3, static_cast<std::int64_t>(getpid()));
    s.exec();
  });
}

void Store::put(const std::string& key, const RunResult& run, const RunCost& cost) {
  guarded(file_, [&] {
    SQLite::Transaction transaction = begin_writing(*database_);
    forget_rows(*database_, key);
    put_cost(*database_, key, cost, calls_json(run.times).dump());
    put_rows(*database_, key, run);
    end_claim(*database_, key);
    transaction.commit();
  });
}

void Store::put_failure(const std::string& key, const RunSpec& spec, const std::string& error,
                        const RunCost& cost) {
  guarded(file_, [&] {
    SQLite::Transaction transaction = begin_writing(*database_);
    forget_rows(*database_, key);
    put_cost(*database_, key, cost, "");
    put_run(*database_, key, spec, error, "");
    end_claim(*database_, key);
    transaction.commit();
  });
}

void Store::forget_failure(const std::string& key) {
  guarded(file_, [&] {
    if (status(key) == RunStatus::kFailed) forget(key);
  });
}

void Store::forget(const std::string& key) {
  guarded(file_, [&] {
    SQLite::Transaction transaction = begin_writing(*database_);
    forget_rows(*database_, key);
    transaction.commit();
  });
}

RunResult Store::load(const std::string& key, const RunSpec& spec) const {
  return guarded(file_, [&] { return load_rows(*database_, file_, key, spec); });
}

double Store::largest_rss_mb() const {
  return guarded(file_, [&] {
    return database_->execAndGet("SELECT coalesce(max(max_rss_mb), 0) FROM times").getDouble();
  });
}

std::vector<std::vector<Store::Value>> Store::values(const std::string& sql) const {
  return guarded(file_, [&] {
    SQLite::Statement s(*database_, sql);
    std::vector<std::vector<Value>> rows(1);
    for (int c = 0; c < s.getColumnCount(); ++c) rows[0].emplace_back(s.getColumnName(c));
    while (s.executeStep()) {
      auto& row = rows.emplace_back();
      for (int c = 0; c < s.getColumnCount(); ++c) {
        const SQLite::Column column = s.getColumn(c);
        if (column.isNull())
          row.emplace_back();
        else if (column.isFloat())
          row.emplace_back(column.getDouble());
        else if (column.isInteger())
          row.emplace_back(column.getInt64());
        else
          row.emplace_back(column.getString());
      }
    }
    return rows;
  });
}

std::vector<std::vector<std::string>> Store::rows(const std::string& sql) const {
  std::vector<std::vector<std::string>> texts;
  for (const auto& row : values(sql)) {
    auto& text = texts.emplace_back();
    for (const Value& value : row)
      if (const auto* number = std::get_if<double>(&value))
        text.push_back(exact(*number));
      else if (const auto* integer = std::get_if<std::int64_t>(&value))
        text.push_back(std::to_string(*integer));
      else if (const auto* word = std::get_if<std::string>(&value))
        text.push_back(*word);
      else
        text.emplace_back();
  }
  return texts;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string exact(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

BenchResults load_results(const Store& store, const Suite& suite) {
  return load_results(store, suite, store.planned_keys());
}

BenchResults load_results(const Store& store, const Suite& suite, const PlannedKeys& keys) {
  const std::map<std::string, std::string> key_of(keys.begin(), keys.end());
  BenchResults results;
  for (const RunSpec& spec : expand(suite)) {
    const auto key = key_of.find(spec.name);
    const auto status = key == key_of.end() ? std::nullopt : store.status(key->second);
    if (status == RunStatus::kDone)
      results.runs.push_back(store.load(key->second, spec));
    else if (status == RunStatus::kFailed)
      results.failed.push_back({spec, store.error(key->second)});
    else
      results.missing.push_back(spec.name);
  }
  return results;
}

}  // namespace mh
