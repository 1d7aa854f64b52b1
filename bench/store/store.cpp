// SPDX-License-Identifier: Apache-2.0
#include "bench/store/store.hpp"

#include <sqlite3.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <ctime>
#include <fstream>
#include <map>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/plan/runs.hpp"
#include "bench/plan/spec_json.hpp"
#include "bench/results/fingerprint.hpp"
#include "bench/store/guard.hpp"
#include "bench/store/result_rows.hpp"
#include "bench/store/schema.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr int kBusy_ms = 60000;

std::int64_t now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string host() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

/// When a process began, in clock ticks since the machine's start; 0 if there is none. With its
/// number this names a process: numbers come round again.
std::int64_t start_of_process(std::int64_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const auto after_name = text.rfind(')');
  if (after_name == std::string::npos) return 0;
  std::istringstream fields(text.substr(after_name + 2));
  std::string field;
  for (int i = 0; i < 20; ++i) fields >> field;  // the 22nd of all
  return fields ? std::strtoll(field.c_str(), nullptr, 10) : 0;
}

InputError made_otherwise(const fs::path& file, const std::string& run, const fs::path& than_in) {
  return InputError(
      fmt::format("{}: run '{}' was made with other settings, input or code than in {}",
                  file.string(), run, than_in.string()));
}

void put_cost(SQLite::Database& db, const std::string& key, const RunCost& cost,
              const std::string& calls) {
  SQLite::Statement s(
      db,
      "INSERT OR REPLACE INTO times (key, wall_s, cpu_s, slam_s, frames_s, max_rss_mb, host, "
      "finished, fingerprint, calls, products_s, sitting, jobs, load) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
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
  if (const Circumstances& c = cost.circumstances; !c.sitting.empty()) {
    s.bind(12, c.sitting);
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

/// A transaction that is begun for writing at once, so that it never has to be given up later.
SQLite::Transaction writing(SQLite::Database& db) {
  return SQLite::Transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
}

/// Two processes that open a new file at once refuse each other the change without waiting.
void enter_wal(SQLite::Database& db) {
  constexpr int kTries = 200;
  for (int tries = 1;; ++tries) {
    try {
      if (db.execAndGet("PRAGMA journal_mode").getString() != "wal")
        db.exec("PRAGMA journal_mode = WAL");
      return;
    } catch (const SQLite::Exception& error) {
      if (error.getErrorCode() != SQLITE_BUSY || tries == kTries) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
}

/// The columns of each table, in order.
std::map<std::string, std::vector<std::string>> columns(SQLite::Database& db) {
  std::map<std::string, std::vector<std::string>> of_table;
  SQLite::Statement s(db,
                      "SELECT m.name, c.name FROM sqlite_master m, pragma_table_info(m.name) c "
                      "WHERE m.type = 'table' ORDER BY m.name, c.cid");
  while (s.executeStep())
    of_table[s.getColumn(0).getString()].push_back(s.getColumn(1).getString());
  return of_table;
}

/// Merging copies whole rows, so that a column more or less is an error. Other tables do no harm.
void require_columns(SQLite::Database& db, const fs::path& file) {
  SQLite::Database fresh(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  fresh.exec(kSchema);
  auto found = columns(db);
  for (const auto& [table, expected] : columns(fresh))
    if (found[table] != expected)
      throw InputError(fmt::format(
          "{}: does not hold what a results file must (the columns of the table '{}'): put back a "
          "copy, or move it away and run again",
          file.string(), table));
}

void open_schema(SQLite::Database& db, const fs::path& file) {
  const auto version = [&] { return db.execAndGet("PRAGMA user_version").getInt(); };
  if (version() > kSchemaVersion)
    throw InputError(
        fmt::format("{}: has schema {}, this version of modelhouse reads up to {}: use a newer one",
                    file.string(), version(), kSchemaVersion));
  enter_wal(db);
  db.exec("PRAGMA synchronous = FULL");
  if (version() == 0) {
    SQLite::Transaction transaction = writing(db);
    if (version() == 0) {  // no other process was quicker
      if (db.execAndGet("SELECT count(*) FROM sqlite_master").getInt() != 0)
        throw InputError(fmt::format("{}: is a database, but no results file", file.string()));
      db.exec(kSchema);
      db.exec(fmt::format("PRAGMA user_version = {}", kSchemaVersion));
    }
    transaction.commit();
  }
  if (version() < kSchemaVersion) {
    SQLite::Transaction transaction = writing(db);
    // Likewise.
    if (version() == 1) {
      db.exec(kFromSchema1);
      db.exec("PRAGMA user_version = 2");
    }
    if (version() == 2) {
      db.exec(kFromSchema2);
      db.exec("PRAGMA user_version = 3");
    }
    transaction.commit();
  }
  if (const std::string found = db.execAndGet("PRAGMA quick_check(1)").getString(); found != "ok")
    throw InputError(
        fmt::format("{}: is damaged ({}): put back a copy, or move it away and run again",
                    file.string(), found));
  require_columns(db, file);
}

nlohmann::ordered_json to_json(const SuiteOverrides& o) {
  return {
      {"scene", o.scene ? nlohmann::ordered_json(fs::absolute(*o.scene).string())
                        : nlohmann::ordered_json()},
      {"trials", o.trials ? nlohmann::ordered_json(*o.trials) : nlohmann::ordered_json()},
      {"frames", o.max_frames ? nlohmann::ordered_json(*o.max_frames) : nlohmann::ordered_json()}};
}

SuiteOverrides overrides_from_json(const nlohmann::json& json) {
  SuiteOverrides o;
  if (!json.at("scene").is_null()) o.scene = json.at("scene").get<std::string>();
  if (!json.at("trials").is_null()) o.trials = json.at("trials").get<int>();
  if (!json.at("frames").is_null()) o.max_frames = json.at("frames").get<std::size_t>();
  return o;
}

}  // namespace

Store::Store(fs::path file) : file_(std::move(file)) {
  guarded(file_, [&] {
    database_ = std::make_unique<SQLite::Database>(
        file_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusy_ms);
    open_schema(*database_, file_);
  });
}
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;

Store Store::open_existing(const fs::path& file) {
  const fs::path found = fs::is_directory(file) ? file / "results.sqlite" : file;
  if (!fs::is_regular_file(found))
    throw InputError(fmt::format("{}: cannot be read: no such results file", found.string()));
  return Store(found);
}

void Store::plan(const Suite& suite, const SuiteOverrides& overrides,
                 const std::vector<std::pair<std::string, std::string>>& key_of_name) {
  guarded(file_, [&] {
    SQLite::Transaction transaction = writing(*database_);
    SQLite::Statement s(*database_, "INSERT OR REPLACE INTO suite VALUES (1, ?, ?, ?, ?)");
    s.bind(1, suite.name);
    s.bind(2, fs::absolute(suite.file).lexically_normal().string());
    s.bind(3, read_file(suite.file));
    s.bind(4, to_json(overrides).dump());
    s.exec();
    database_->exec("DELETE FROM plan");
    SQLite::Statement row(*database_, "INSERT INTO plan VALUES (?, ?, ?)");
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
                       overrides_from_json(nlohmann::json::parse(s.getColumn(2).getString())),
                       false);  // they may have been made on another machine
  });
}

std::vector<std::pair<std::string, std::string>> Store::planned_keys() const {
  return guarded(file_, [&] {
    std::vector<std::pair<std::string, std::string>> keys;
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
    SQLite::Transaction transaction = writing(*database_);
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
    SQLite::Transaction transaction = writing(*database_);
    forget_rows(*database_, key);
    put_rows(*database_, key, run);
    put_cost(*database_, key, cost, calls_json(run.times).dump());
    end_claim(*database_, key);
    transaction.commit();
  });
}

void Store::put_failure(const std::string& key, const RunSpec& spec, const std::string& error,
                        const RunCost& cost) {
  guarded(file_, [&] {
    SQLite::Transaction transaction = writing(*database_);
    forget_rows(*database_, key);
    put_run(*database_, key, spec, error, "");
    put_cost(*database_, key, cost, "");
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
    SQLite::Transaction transaction = writing(*database_);
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

void Store::check_mergeable(const std::vector<fs::path>& files) {
  std::map<std::string, std::pair<std::string, fs::path>> planned;  // of each run: key, first file
  std::optional<std::pair<Suite, fs::path>> first;
  for (const fs::path& file : files) {
    const Store store = open_existing(file);
    const auto keys = store.planned_keys();
    if (keys.empty()) continue;
    const Suite suite = store.planned_suite();
    if (!first) first.emplace(suite, file);
    const auto differs = [&](const std::string& what, const auto& here, const auto& there) {
      return InputError(
          fmt::format("{}: {} {}, {} has {}: parts of one suite must not differ in it",
                      file.string(), what, here, first->second.string(), there));
    };
    if (suite.name != first->first.name)
      throw InputError(fmt::format("{}: holds results of the suite '{}', {} of '{}'", file.string(),
                                   suite.name, first->second.string(), first->first.name));
    for (const auto& [run, key] : keys) {
      const auto [of_run, is_new] = planned.try_emplace(run, key, file);
      if (!is_new && of_run->second.first != key)
        throw made_otherwise(file, run, of_run->second.second);
    }
    if (suite.trials != first->first.trials)
      throw differs("was run with --trials", suite.trials, first->first.trials);
    // A damaged run is found here, while its file can be named and nothing is written.
    const std::map<std::string, std::string> key_of(keys.begin(), keys.end());
    for (const RunSpec& spec : expand(suite))
      if (const auto key = key_of.find(spec.name);
          key != key_of.end() && store.status(key->second) == RunStatus::kDone)
        store.load(key->second, spec);
    // Every part plans the whole suite, whatever its own share.
    if (keys.size() != planned.size())
      throw differs("number of runs:", keys.size(), planned.size());
    const auto margin = [](const Suite& s) { return s.non_inferiority_margin.value_or(0); };
    if (margin(suite) != margin(first->first))
      throw differs("non_inferiority_margin", margin(suite), margin(first->first));
  }
}

std::size_t Store::merge(const fs::path& other) {
  const Store source = open_existing(other);
  return guarded(file_, [&] {
    std::size_t taken = 0;
    SQLite::Statement attach(*database_, "ATTACH ? AS other");
    attach.bind(1, source.file().string());
    attach.exec();
    {
      SQLite::Transaction transaction = writing(*database_);
      SQLite::Statement clash(*database_,
                              "SELECT a.name FROM plan a JOIN other.plan b ON a.name = b.name "
                              "WHERE a.key <> b.key LIMIT 1");
      if (clash.executeStep()) throw made_otherwise(other, clash.getColumn(0).getString(), file_);
      clash.reset();
      database_->exec("INSERT OR IGNORE INTO suite SELECT * FROM other.suite");
      // What is finished here stays; a failure gives way to a result.
      database_->exec(
          "CREATE TEMP TABLE wanted AS SELECT key FROM other.runs o WHERE NOT EXISTS "
          "(SELECT 1 FROM runs r WHERE r.key = o.key AND (r.status = 'done' OR o.status = "
          "'failed'))");
      taken = database_->execAndGet("SELECT COUNT(*) FROM wanted").getUInt();
      for (const char* table :
           {"runs", "points", "metrics", "calls", "frames", "queries", "times"}) {
        database_->exec(
            fmt::format("DELETE FROM {0} WHERE key IN (SELECT key FROM wanted)", table));
        database_->exec(fmt::format(
            "INSERT INTO {0} SELECT * FROM other.{0} WHERE key IN (SELECT key FROM wanted)",
            table));
      }
      database_->exec("INSERT OR IGNORE INTO plan SELECT * FROM other.plan");
      database_->exec("DROP TABLE wanted");
      transaction.commit();
    }
    database_->exec("DETACH other");
    return taken;
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

}  // namespace mh
