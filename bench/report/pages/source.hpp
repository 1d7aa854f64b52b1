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

/// Everything that the pages show about one results folder. What the folder lacks is empty, and
/// `problem` states in one line why nothing could be read.
struct PagesSource {
  std::string name;                 ///< a heading: the last part of the folder's path
  std::filesystem::path folder;     ///< empty: the results exist in memory alone
  std::string problem = {};         ///< e.g. results of an older version
  std::optional<Suite> suite = {};  ///< as it was planned
  BenchResults results = {};
  std::map<std::string, RunCost> cost_of = {};  ///< by name of the run, where it is known
  std::map<std::string, std::string> host_of = {};
  nlohmann::ordered_json reproduction = {};  ///< the folder's reproduction.json, or null
  nlohmann::ordered_json audit = {};         ///< the folder's audit.json, or null
  std::string audit_csv = {};                ///< the folder's audit.csv: a line per query
  std::vector<std::string> damaged = {};     ///< files of the folder that could not be read
  /// Frames of the first recording, if it is available (frames_json()); null if not requested.
  nlohmann::ordered_json frames = {};
  /// What was recorded by repeating runs (bench/audit/replay), by name.
  std::map<std::string, nlohmann::ordered_json> replay_of = {}, views_of = {};
};

/// The grid of a run's map, from the results or from the run's folder; nullopt if there is none, or
/// if it is damaged.
std::optional<OccupancyGrid> grid_of(const PagesSource& source, const RunResult& run);

/// Reads a results folder or file. A damaged file, one of another version and one without a suite
/// give a source with a problem. @throws InputError if there is nothing to read.
PagesSource read_source(const std::filesystem::path& folder);

}  // namespace mh
