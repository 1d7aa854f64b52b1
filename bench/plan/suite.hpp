// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/protocol/config.hpp"
#include "sim/sensors/sensors.hpp"
#include "slam/pipeline/config.hpp"

namespace mh {

enum class SystemKind { kSemantic, kPlain };
std::string_view name(SystemKind system);
std::string_view name(LabelMode labels);
std::string_view name(Overlap overlap);

/// A benchmark as data: one place, one robot, its tours, and the grid of runs over it.
struct Suite {
  std::string name;
  std::filesystem::path file;
  std::filesystem::path scene, robot, mapping_tour, vocabulary;
  std::optional<std::filesystem::path> query_tour;  ///< the second tour; none: held-out frames only
  std::vector<std::filesystem::path> levels;  ///< sensor settings; a level is named by its file
  std::vector<SystemKind> systems;
  std::vector<LabelMode> labels;
  int trials = 1;
  std::uint64_t seed = 0;  ///< trial t uses seed + t
  SemanticConfig semantics;
  ProtocolConfig protocol;
};

/// What the command line may put in the place of a suite's own settings.
struct SuiteOverrides {
  std::optional<std::filesystem::path> scene = {};
  std::optional<int> trials = {};
};

/// Reads a suite (YAML); its paths are relative to its own folder and must exist.
/// @throws InputError naming file, line, field and value.
Suite load_suite(const std::filesystem::path& file, const SuiteOverrides& overrides = {});

std::string level_name(const std::filesystem::path& level);

}  // namespace mh
