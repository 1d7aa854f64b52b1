// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace mh {

/// `PRAGMA user_version` of a results file; a file with another one is refused.
inline constexpr int kSchemaVersion = 15;

/// The tables of a results file, as CREATE statements; docs/store.md explains each column. `runs`,
/// `points`, `metrics`, `calls`, `frames`, `queries` and `episodes` are a function of suite, seeds
/// and binary; `times` and `claims` contain everything that is not. The last column is a digest of
/// the others (row_digest.hpp).
std::string schema();

}  // namespace mh
