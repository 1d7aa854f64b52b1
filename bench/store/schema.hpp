// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mh {

/// `PRAGMA user_version` of a results file; a file of a higher one is refused, one of a lower one
/// changed.
inline constexpr int kSchemaVersion = 4;

/// docs/store.md explains each column. `runs`, `points`, `metrics`, `frames` and `queries` are a
/// function of suite, seeds and binary; `times` and `claims` hold all that is not. `digest` stands
/// last and is that of the other columns (row_digest.hpp).
inline constexpr const char* kSchema = R"sql(
CREATE TABLE suite (
  one INTEGER PRIMARY KEY CHECK (one = 1), name TEXT NOT NULL, file TEXT NOT NULL,
  content TEXT NOT NULL, overrides TEXT NOT NULL, digest INTEGER);
CREATE TABLE plan (
  position INTEGER NOT NULL, name TEXT PRIMARY KEY, key TEXT NOT NULL, digest INTEGER)
  WITHOUT ROWID;
CREATE TABLE runs (
  key TEXT PRIMARY KEY, name TEXT NOT NULL, environment TEXT NOT NULL, category TEXT NOT NULL,
  level TEXT NOT NULL, system TEXT NOT NULL, labels TEXT NOT NULL, trial INTEGER NOT NULL,
  seed INTEGER NOT NULL, status TEXT NOT NULL CHECK (status IN ('done', 'failed')),
  error TEXT NOT NULL, spec TEXT NOT NULL, result TEXT NOT NULL, digest INTEGER) WITHOUT ROWID;
CREATE TABLE points (
  key TEXT NOT NULL, point INTEGER NOT NULL, gamma REAL, xi REAL, alpha REAL, beta REAL,
  overlap TEXT, void_is_a_label INTEGER, digest INTEGER, PRIMARY KEY (key, point)) WITHOUT ROWID;
CREATE TABLE metrics (
  key TEXT NOT NULL, point INTEGER NOT NULL, name TEXT NOT NULL, value REAL, digest INTEGER,
  PRIMARY KEY (key, point, name)) WITHOUT ROWID;
CREATE TABLE calls (
  key TEXT NOT NULL, call INTEGER NOT NULL, frame INTEGER NOT NULL, stamp_ns INTEGER NOT NULL,
  restart INTEGER NOT NULL, status TEXT NOT NULL, inliers INTEGER,
  keyframe INTEGER NOT NULL, image TEXT NOT NULL, matching TEXT NOT NULL, pose TEXT NOT NULL,
  digest INTEGER, PRIMARY KEY (key, call)) WITHOUT ROWID;
CREATE TABLE frames (
  key TEXT NOT NULL, frame INTEGER NOT NULL, stamp_ns INTEGER NOT NULL,
  true_tx REAL, true_ty REAL, true_tz REAL, true_qx REAL, true_qy REAL, true_qz REAL, true_qw REAL,
  tx REAL, ty REAL, tz REAL, qx REAL, qy REAL, qz REAL, qw REAL,
  digest INTEGER, PRIMARY KEY (key, frame)) WITHOUT ROWID;
CREATE TABLE queries (
  key TEXT NOT NULL, point INTEGER NOT NULL, query_set TEXT NOT NULL, frame INTEGER NOT NULL,
  stamp_ns INTEGER NOT NULL, success INTEGER NOT NULL, correct INTEGER NOT NULL,
  wrong INTEGER NOT NULL, stage TEXT, attempts INTEGER NOT NULL,
  blank_frames INTEGER NOT NULL, distance_m REAL, angle_deg REAL, aligned_distance_m REAL,
  keyframes INTEGER, c1 INTEGER, c2 INTEGER, c3 INTEGER, final INTEGER, label_mass REAL,
  true_tx REAL, true_ty REAL, true_tz REAL, true_qx REAL, true_qy REAL, true_qz REAL, true_qw REAL,
  tx REAL, ty REAL, tz REAL, qx REAL, qy REAL, qz REAL, qw REAL,
  image TEXT NOT NULL, matching TEXT NOT NULL, pose TEXT NOT NULL, matchers TEXT,
  digest INTEGER, PRIMARY KEY (key, point, query_set, frame)) WITHOUT ROWID;
CREATE TABLE times (
  key TEXT PRIMARY KEY, wall_s REAL, cpu_s REAL, slam_s REAL, frames_s REAL, max_rss_mb REAL,
  host TEXT, finished TEXT, fingerprint TEXT, calls TEXT,
  products_s REAL, sitting TEXT, jobs INTEGER, load REAL, digest INTEGER) WITHOUT ROWID;
CREATE TABLE claims (
  key TEXT PRIMARY KEY, host TEXT NOT NULL, process INTEGER NOT NULL, started INTEGER NOT NULL,
  beat INTEGER NOT NULL) WITHOUT ROWID;
)sql";

/// What makes a file of schema 1 one of schema 2, whose tables and columns are those of 3. (2 could
/// not say that an outside program does not tell something; the zeros that it holds there stay.)
inline constexpr const char* kFromSchema1 = R"sql(
ALTER TABLE times ADD COLUMN products_s REAL;
ALTER TABLE times ADD COLUMN sitting TEXT;
ALTER TABLE times ADD COLUMN jobs INTEGER;
ALTER TABLE times ADD COLUMN load REAL;
)sql";

}  // namespace mh
