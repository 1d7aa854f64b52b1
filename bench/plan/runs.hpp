// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/plan/suite.hpp"
#include "slam/config/semantics.hpp"

namespace mh {

/// One run: a system maps an environment once and answers the queries. Whole by itself: everything
/// that decides the result stands here or in the files that it names.
struct RunSpec {
  std::string name;  ///< unique in the suite, fit for a folder: "semantic-exact-pepper-0"
  Environment environment;
  std::filesystem::path level, vocabulary;
  SystemSpec system;
  LabelMode labels = LabelMode::kNone;
  int trial = 0;
  std::uint64_t seed = 0;  ///< of the trial
  SharedSlamConfig slam;   ///< settings while mapping; the plain system's are neutral
  /// Settings of the queries: one pass over all queries for each, on the same map. At least one.
  std::vector<SemanticConfig> points;
  ProtocolConfig protocol;
  std::optional<std::size_t> max_frames;
};

/// Settings as a system sees them: the plain one with the method at neutral, an outside program
/// none.
SlamConfig settings_of(const SystemSpec& system, const SlamConfig& settings);

/// The parameter points of a suite: those of its sweep, else its own settings alone.
std::vector<SharedSlamConfig> parameter_points(const Suite& suite);

/// Every run, ordered by environment, level, trial, parameters, system, labels. The plain system
/// never looks at labels (a law with its own test), so it runs once and stands beside each kind of
/// label. A parameter that a system does not look at makes no more runs and no more points of it:
/// of a sweep the plain system takes those that differ in alpha or beta, an outside program none.
std::vector<RunSpec> expand(const Suite& suite);

}  // namespace mh
