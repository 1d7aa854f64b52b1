// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>
#include <nlohmann/json.hpp>

#include "bench/protocol/run_result.hpp"

namespace mh {

// Converts a run to rows of the tables of schema.hpp and back. All functions work within the
// caller's transaction.

/// Stores the row in `runs`. Call it after the run's other rows are stored, since it counts them.
void put_run(SQLite::Database& db, const std::string& key, const RunSpec& spec,
             const std::string& error, const std::string& result);
void put_rows(SQLite::Database& db, const std::string& key, const RunResult& run);
void forget_rows(SQLite::Database& db, const std::string& key);
/// @param file  contains the database; for messages
RunResult load_rows(SQLite::Database& db, const std::filesystem::path& file, const std::string& key,
                    const RunSpec& spec);

/// Times of all calls: not part of what is compared.
nlohmann::ordered_json calls_json(const CallTimes& times);

}  // namespace mh
