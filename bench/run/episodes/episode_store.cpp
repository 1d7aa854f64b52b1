// SPDX-License-Identifier: Apache-2.0
#include "bench/run/episodes/episode_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include "bench/store/columns.hpp"
#include "bench/store/database.hpp"
#include "bench/store/guard.hpp"
#include "bench/store/schema.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr int kBusy_ms = 60000;

std::string episodes_schema() {
  return fmt::format(
      "CREATE TABLE episodes (\n  key TEXT NOT NULL, run TEXT NOT NULL,\n{}"
      "  digest_of_row INTEGER, PRIMARY KEY (key, variant, start)) WITHOUT ROWID;",
      columns_of<EpisodeScore>());
}

}  // namespace

EpisodeStore::EpisodeStore(const std::filesystem::path& file) : file_(file) {
  guarded(file, [&] {
    database_ = std::make_unique<SQLite::Database>(
        file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusy_ms);
    add_row_digest(*database_);
    require_whole_pages(*database_, file);
    const int version = database_->execAndGet("PRAGMA user_version").getInt();
    if (version == kEpisodesVersion) return require_whole_table(*database_, file, "episodes");
    if (version != 0 || database_->execAndGet("SELECT count(*) FROM sqlite_master").getInt() != 0)
      throw InputError(fmt::format(
          "{}: is no file of episodes of this version: move it away and run again", file.string()));
    database_->exec(episodes_schema());
    database_->exec(fmt::format("PRAGMA user_version = {}", kEpisodesVersion));
  });
}

EpisodeStore::~EpisodeStore() = default;

void EpisodeStore::put(const std::string& key, const std::string& run, const EpisodeScore& score) {
  SQLite::Transaction transaction = begin_writing(*database_);
  SQLite::Statement old(*database_,
                        "DELETE FROM episodes WHERE key = ? AND variant = ? AND start = ?");
  old.bind(1, key);
  old.bind(2, score.variant);
  old.bind(3, static_cast<std::int64_t>(score.start));
  old.exec();
  RowWriter row(*database_, "episodes");
  row << key << run << score;
  row.end_row();
  transaction.commit();
}

std::vector<EpisodeScore> EpisodeStore::load(const std::string& key) const {
  std::vector<EpisodeScore> scores;
  SQLite::Statement rows(*database_,
                         "SELECT * FROM episodes WHERE key = ? ORDER BY variant, start");
  rows.bind(1, key);
  while (rows.executeStep()) {
    RowReader reader(rows, 2);  // behind key and run
    fields(scores.emplace_back(), reader);
  }
  return scores;
}

}  // namespace mh
