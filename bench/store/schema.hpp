// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace mh {

/// `PRAGMA user_version` of a results file; a file of another one is refused.
inline constexpr int kSchemaVersion = 6;

/// The tables of a results file, as CREATE statements; docs/store.md explains each column. `runs`,
/// `points`, `metrics`, `calls`, `frames` and `queries` are a function of suite, seeds and binary;
/// `times` and `claims` hold all that is not. `digest` stands last and is that of the other columns
/// (row_digest.hpp).
std::string schema();

}  // namespace mh
