// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/store/store.hpp"
#include "bench/suite/suite.hpp"

namespace mh {

/// Everything that the pages show about one results folder. Members are empty if the folder lacks
/// their data. If nothing could be read, `problem` states why in one line.
struct PagesSource {
  std::string name;                 ///< a heading: the last part of the folder's path
  std::filesystem::path folder;     ///< empty if the results exist only in memory
  std::string problem = {};         ///< e.g. results of an older version
  std::optional<Suite> suite = {};  ///< as it was planned
  BenchResults results = {};
  std::map<std::string, RunCost> cost_of = {};  ///< by run name; known costs only
  std::map<std::string, std::string> host_of = {};
  nlohmann::ordered_json reproduction = {};  ///< the folder's reproduction.json, or null
  nlohmann::ordered_json audit = {};         ///< the folder's audit.json, or null
  std::string audit_csv = {};                ///< the folder's audit.csv: a line per query
  std::vector<std::string> damaged = {};     ///< damaged files of the folder
  /// Frames of the first recording, if it is available (see frames_json()); null if not requested.
  nlohmann::ordered_json frames = {};
  /// What was recorded when runs were repeated (bench/audit/replay), by the run's name.
  std::map<std::string, nlohmann::ordered_json> replay_of = {}, views_of = {};
};

/// The grid of a run's map, from the results or from the run's folder; nullopt if there is none, or
/// if it is damaged.
std::optional<OccupancyGrid> grid_of(const PagesSource& source, const RunResult& run);

/// Reads a results folder or file. If the file is damaged, from a different version or without a
/// suite, the source has a `problem`. @throws InputError if there is nothing to read.
PagesSource read_source(const std::filesystem::path& folder);

}  // namespace mh
