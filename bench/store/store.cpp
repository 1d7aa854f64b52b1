// SPDX-License-Identifier: Apache-2.0
#include "bench/store/store.hpp"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <ctime>
#include <fstream>
#include <map>
#include <thread>

#include <SQLiteCpp/Backup.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/plan/runs.hpp"
#include "bench/plan/spec_json.hpp"
#include "bench/provenance/fingerprint.hpp"
#include "bench/store/guard.hpp"
#include "bench/store/result_rows.hpp"
#include "bench/store/row_digest.hpp"
#include "bench/store/schema.hpp"
#include "slam/core/file_errors.hpp"
#include "slam/core/files.hpp"
#include "slam/core/json_number.hpp"
#include "slam/core/temporary_folder.hpp"

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

/// Merging copies whole rows, so that a column more or less is an error, and one of another type
/// would give other numbers. Other tables do no harm.
void require_schema(SQLite::Database& db, const fs::path& file) {
  SQLite::Database fresh(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  fresh.exec(kSchema);
  auto found = schema_texts(db);
  for (const auto& [table, expected] : schema_texts(fresh))
    if (found[table] != expected)
      throw InputError(fmt::format(
          "{}: does not hold what a results file must (the columns of the table '{}'): put back a "
          "copy, or move it away and run again",
          file.string(), table));
}

int version_of(SQLite::Database& db) {
  return db.execAndGet("PRAGMA user_version").getInt();
}

void refuse_newer(SQLite::Database& db, const fs::path& file) {
  if (const int version = version_of(db); version > kSchemaVersion)
    throw InputError(
        fmt::format("{}: has schema {}, this version of modelhouse reads up to {}: use a newer one",
                    file.string(), version, kSchemaVersion));
}

/// SQLite's own look at its pages; rows are for require_whole_rows().
void require_whole_pages(SQLite::Database& db, const fs::path& file) {
  if (const std::string found = db.execAndGet("PRAGMA quick_check(1)").getString(); found != "ok")
    throw InputError(
        fmt::format("{}: is damaged ({}): put back a copy, or move it away and run again",
                    file.string(), found));
}

void bring_up_to_date(SQLite::Database& db) {
  SQLite::Transaction transaction = writing(db);
  const int version = version_of(db);
  if (version >= kSchemaVersion) return;  // another process was quicker
  if (version == 1) db.exec(kFromSchema1);
  rebuild_with_digests(db);
  db.exec(fmt::format("PRAGMA user_version = {}", kSchemaVersion));
  transaction.commit();
}

void open_schema(SQLite::Database& db, const fs::path& file) {
  refuse_newer(db, file);
  enter_wal(db);
  db.exec("PRAGMA synchronous = FULL");
  if (version_of(db) == 0) {
    SQLite::Transaction transaction = writing(db);
    if (version_of(db) == 0) {  // no other process was quicker
      if (db.execAndGet("SELECT count(*) FROM sqlite_master").getInt() != 0)
        throw InputError(fmt::format("{}: is a database, but no results file", file.string()));
      db.exec(kSchema);
      db.exec(fmt::format("PRAGMA user_version = {}", kSchemaVersion));
    }
    transaction.commit();
  }
  require_whole_pages(db, file);
  if (version_of(db) < kSchemaVersion) bring_up_to_date(db);
  require_schema(db, file);
}

/// Whether SQLite may write the file and, beside it, its log.
bool may_be_written(const fs::path& file) {
  const fs::path folder = fs::absolute(file).parent_path();
  return faccessat(AT_FDCWD, file.c_str(), W_OK, AT_EACCESS) == 0 &&
         faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) == 0;
}

fs::path log_of(const fs::path& file) {
  return file.string() + "-wal";
}

/// The name under which SQLite opens a file that nobody writes, without a lock or a log.
std::string as_immutable(const fs::path& file) {
  std::string name = "file:";
  for (const char c : fs::absolute(file).string())
    name += std::string_view("%?#").find(c) == std::string_view::npos
                ? std::string(1, c)
                : fmt::format("%{:02X}", static_cast<unsigned>(c));
  return name + "?immutable=1";
}

nlohmann::ordered_json to_json(const SuiteOverrides& o) {
  nlohmann::ordered_json json = {
      {"scene", o.scene ? nlohmann::ordered_json(fs::absolute(*o.scene).string())
                        : nlohmann::ordered_json()},
      {"trials", o.trials ? nlohmann::ordered_json(*o.trials) : nlohmann::ordered_json()},
      {"frames", o.max_frames ? nlohmann::ordered_json(*o.max_frames) : nlohmann::ordered_json()}};
  if (o.frame != SceneFrame{}) json["scene_frame"] = to_json(o.frame);
  if (!o.set.empty()) json["set"] = o.set;
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
  if (json.contains("scene_frame")) o.frame = scene_frame_from_json(json.at("scene_frame"));
  if (json.contains("set")) o.set = json.at("set");
  if (json.contains("found"))
    for (const auto& [pattern, found] : json.at("found").items())
      for (const auto& recording : found)
        o.found[pattern].push_back({recording.at(0), recording.at(1)});
  return o;
}

}  // namespace

Store::Store(fs::path file) : file_(std::move(file)) {
  guarded(file_, [&] {
    database_ = std::make_unique<SQLite::Database>(
        fs::absolute(file_).string(),
        SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE | SQLite::OPEN_URI, kBusy_ms);
    add_row_digest(*database_);
    open_schema(*database_, file_);
  });
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
  guarded(found, [&] { store.open_unchanged(); });
  return store;
}

void Store::open_unchanged() {
  const auto open = [&](const std::string& name) {
    opened_ = name;
    database_ = std::make_unique<SQLite::Database>(name, SQLite::OPEN_READWRITE | SQLite::OPEN_URI,
                                                   kBusy_ms);
    add_row_digest(*database_);
  };
  const auto copy_to = [&] {
    copy_ = std::make_unique<TemporaryFolder>(fs::temp_directory_path());
    return copy_->path() / "results.sqlite";
  };
  std::error_code error;
  if (may_be_written(file_)) {
    open(fs::absolute(file_).string());
  } else if (const auto left = fs::file_size(log_of(file_), error); error || left == 0) {
    open(as_immutable(file_));
  } else {  // what stands in the log has to be put into some file
    const fs::path copy = copy_to();
    write_atomically(copy, read_file(file_));
    write_atomically(log_of(copy), read_file(log_of(file_)));
    open(copy.string());
  }
  refuse_newer(*database_, file_);
  require_whole_pages(*database_, file_);
  if (version_of(*database_) < kSchemaVersion) {
    if (version_of(*database_) == 0)
      throw InputError(fmt::format("{}: is a database, but no results file", file_.string()));
    const std::unique_ptr<SQLite::Database> old = std::move(database_);
    const fs::path copy = copy_to();
    {
      SQLite::Database fresh(copy.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
      SQLite::Backup(fresh, *old).executeStep(-1);
    }
    open(copy.string());
    bring_up_to_date(*database_);
  }
  require_schema(*database_, file_);
  require_whole_rows(*database_, file_);
}

void Store::check() const {
  guarded(file_, [&] { require_whole_rows(*database_, file_); });
}

void Store::plan(const Suite& suite, const SuiteOverrides& overrides,
                 const std::vector<std::pair<std::string, std::string>>& key_of_name) {
  guarded(file_, [&] {
    SQLite::Transaction transaction = writing(*database_);
    SQLite::Statement s(*database_, insert_row("suite", 5, "INSERT OR REPLACE"));
    s.bind(1, 1);
    s.bind(2, suite.name);
    s.bind(3, fs::absolute(suite.file).lexically_normal().string());
    s.bind(4, read_file(suite.file));
    SuiteOverrides stored = overrides;
    stored.found = suite.found;  // read back where the recordings need not be
    s.bind(5, to_json(stored).dump());
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
    const Store store = open_to_read(file);
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
  const Store source = open_to_read(other);
  return guarded(file_, [&] {
    std::size_t taken = 0;
    SQLite::Statement attach(*database_, "ATTACH ? AS other");
    attach.bind(1, source.opened_);
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
