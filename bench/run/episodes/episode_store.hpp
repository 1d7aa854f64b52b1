// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/run/episodes/episode.hpp"

namespace SQLite {
class Database;
}

namespace mh {

/// The results of episodes in one SQLite file, a row each, with the row digests of results.sqlite
/// (docs/store.md). An episode is stored when it has ended: whenever the process dies, the same
/// command resumes with the next one.
class EpisodeStore {
 public:
  /// Opens or creates the file. @throws InputError if it is something else, or a row is damaged.
  explicit EpisodeStore(const std::filesystem::path& file);
  ~EpisodeStore();
  EpisodeStore(const EpisodeStore&) = delete;
  EpisodeStore& operator=(const EpisodeStore&) = delete;

  /// Replaces what was stored for this key, variant and start.
  void put(const std::string& key, const std::string& run, const EpisodeScore& score);
  /// Episodes of a run, ordered by variant and start.
  std::vector<EpisodeScore> load(const std::string& key) const;

 private:
  std::filesystem::path file_;
  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace mh
