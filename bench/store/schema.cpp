// SPDX-License-Identifier: Apache-2.0
#include "bench/store/schema.hpp"

#include <fmt/format.h>

#include "bench/protocol/episode_score.hpp"
#include "bench/protocol/mapping.hpp"
#include "bench/protocol/score.hpp"
#include "bench/store/columns.hpp"

namespace mh {

std::string schema() {
  return fmt::format(
      R"sql(
CREATE TABLE suite (
  one INTEGER PRIMARY KEY CHECK (one = 1), name TEXT NOT NULL, file TEXT NOT NULL,
  content TEXT NOT NULL, overrides TEXT NOT NULL, run_count INTEGER NOT NULL, digest INTEGER);
CREATE TABLE plan (
  position INTEGER NOT NULL, name TEXT PRIMARY KEY, key TEXT NOT NULL, digest INTEGER)
  WITHOUT ROWID;
CREATE TABLE runs (
  key TEXT PRIMARY KEY, name TEXT NOT NULL, environment TEXT NOT NULL, category TEXT NOT NULL,
  level TEXT NOT NULL, system TEXT NOT NULL, labels TEXT NOT NULL, trial INTEGER NOT NULL,
  seed INTEGER NOT NULL, status TEXT NOT NULL CHECK (status IN ('done', 'failed')),
  error TEXT NOT NULL, spec TEXT NOT NULL, result TEXT NOT NULL, row_count INTEGER NOT NULL,
  digest INTEGER) WITHOUT ROWID;
CREATE TABLE points (
  key TEXT NOT NULL, point INTEGER NOT NULL,
{}  digest INTEGER, PRIMARY KEY (key, point)) WITHOUT ROWID;
CREATE TABLE metrics (
  key TEXT NOT NULL, point INTEGER NOT NULL, name TEXT NOT NULL, value REAL, digest INTEGER,
  PRIMARY KEY (key, point, name)) WITHOUT ROWID;
CREATE TABLE calls (
  key TEXT NOT NULL, call INTEGER NOT NULL,
{}  digest INTEGER, PRIMARY KEY (key, call)) WITHOUT ROWID;
CREATE TABLE frames (
  key TEXT NOT NULL,
{}  digest INTEGER, PRIMARY KEY (key, frame)) WITHOUT ROWID;
CREATE TABLE queries (
  key TEXT NOT NULL, point INTEGER NOT NULL, query_set TEXT NOT NULL,
{}  digest INTEGER, PRIMARY KEY (key, point, query_set, frame)) WITHOUT ROWID;
CREATE TABLE episodes (
  key TEXT NOT NULL, episode INTEGER NOT NULL,
{}  digest_of_row INTEGER, PRIMARY KEY (key, episode)) WITHOUT ROWID;
CREATE TABLE times (
  key TEXT PRIMARY KEY, wall_s REAL, cpu_s REAL, slam_s REAL, frames_s REAL, max_rss_mb REAL,
  host TEXT, finished TEXT, fingerprint TEXT, calls TEXT,
  products_s REAL, session_start TEXT, jobs INTEGER, load REAL, digest INTEGER) WITHOUT ROWID;
CREATE TABLE claims (
  key TEXT PRIMARY KEY, host TEXT NOT NULL, process INTEGER NOT NULL, started INTEGER NOT NULL,
  beat INTEGER NOT NULL) WITHOUT ROWID;
)sql",
      columns_of<SemanticConfig>(), columns_of<MappedFrame>(), columns_of<FrameRow>(),
      columns_of<QueryScore>(), columns_of<EpisodeScore>());
}

}  // namespace mh
