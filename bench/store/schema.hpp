// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace mh {

/// `PRAGMA user_version` of a results file; a file with another one is refused.
inline constexpr int kSchemaVersion = 12;
/// The same of a file of episodes (bench/run/episodes/episode_store.hpp), which counts from 1001.
inline constexpr int kEpisodesVersion = 1001;

/// The tables of a results file, as CREATE statements; docs/store.md explains each column. `runs`,
/// `points`, `metrics`, `calls`, `frames` and `queries` are a function of suite, seeds and binary;
/// `times` and `claims` contain everything that is not. `digest` is the last column and covers the
/// others (row_digest.hpp).
std::string schema();

}  // namespace mh
