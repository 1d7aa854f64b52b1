// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "bench/store/database.hpp"
#include "bench/store/guard.hpp"
#include "bench/store/row_digest.hpp"
#include "bench/store/store.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

InputError made_otherwise(const fs::path& file, const std::string& run, const fs::path& than_in) {
  return InputError(
      fmt::format("{}: run '{}' was made with settings, input or code different from those in {}",
                  file.string(), run, than_in.string()));
}

/// Checks that runs that are finished in both files have the same results; their times may differ.
void require_same_results(SQLite::Database& db, const fs::path& other, const fs::path& file) {
  std::string differs = "a.result <> b.result";
  for (const std::string_view table : kTablesOfRuns)
    if (table != "times")
      differs += fmt::format(
          " OR EXISTS (SELECT * FROM main.{0} WHERE key = a.key EXCEPT SELECT * FROM other.{0} "
          "WHERE key = a.key)",
          table);
  SQLite::Statement found(
      db, fmt::format("SELECT a.name FROM runs a JOIN other.runs b ON a.key = b.key WHERE "
                      "a.status = 'done' AND b.status = 'done' AND ({}) ORDER BY a.name LIMIT 1",
                      differs));
  if (found.executeStep())
    throw InputError(fmt::format(
        "{}: run '{}' has a different result from the one in {}, though all that determines it is "
        "the same: its program is not repeatable, or one of them is wrong; leave one out",
        other.string(), found.getColumn(0).getString(), file.string()));
}

}  // namespace

void Store::check_mergeable(const std::vector<fs::path>& files) {
  std::map<std::string, std::pair<std::string, fs::path>> planned;  // by run: key, first file
  std::optional<std::pair<Suite, fs::path>> first;
  for (const fs::path& file : files) {
    const Store store = open_to_read(file);
    const auto keys = store.planned_keys();
    if (keys.empty()) continue;
    const Suite suite = store.planned_suite();
    if (!first) first.emplace(suite, file);
    const auto differs = [&](const std::string& what, const auto& here, const auto& there) {
      return InputError(fmt::format("{}: {} {}, {} has {}: parts of one suite must agree",
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
    // A damaged run is found here, while its file can be named and nothing has been written yet.
    const std::map<std::string, std::string> key_of(keys.begin(), keys.end());
    for (const RunSpec& spec : expand(suite))
      if (const auto key = key_of.find(spec.name);
          key != key_of.end() && store.status(key->second) == RunStatus::kDone)
        store.load(key->second, spec);
    // Every part plans the whole suite, regardless of its own share.
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
      SQLite::Transaction transaction = begin_writing(*database_);
      SQLite::Statement clash(*database_,
                              "SELECT a.name FROM plan a JOIN other.plan b ON a.name = b.name "
                              "WHERE a.key <> b.key LIMIT 1");
      if (clash.executeStep()) throw made_otherwise(other, clash.getColumn(0).getString(), file_);
      clash.reset();
      require_same_results(*database_, other, file_);
      database_->exec("INSERT OR IGNORE INTO suite SELECT * FROM other.suite");
      // Finished results of this store are kept; a failure in it is replaced by the other store's
      // result.
      database_->exec(
          "CREATE TEMP TABLE wanted AS SELECT key FROM other.runs o WHERE NOT EXISTS "
          "(SELECT 1 FROM runs r WHERE r.key = o.key AND (r.status = 'done' OR o.status = "
          "'failed'))");
      taken = database_->execAndGet("SELECT COUNT(*) FROM wanted").getUInt();
      const auto replace = [&](const char* table) {
        database_->exec(
            fmt::format("DELETE FROM {0} WHERE key IN (SELECT key FROM wanted)", table));
        database_->exec(fmt::format(
            "INSERT INTO {0} SELECT * FROM other.{0} WHERE key IN (SELECT key FROM wanted)",
            table));
      };
      replace("runs");
      std::ranges::for_each(kTablesOfRuns, replace);
      database_->exec("INSERT OR IGNORE INTO plan SELECT * FROM other.plan");
      database_->exec("DROP TABLE wanted");
      transaction.commit();
    }
    database_->exec("DETACH other");
    return taken;
  });
}

}  // namespace mh
