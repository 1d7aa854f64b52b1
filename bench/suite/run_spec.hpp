// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/suite/suite.hpp"
#include "slam/config/semantics.hpp"

namespace mh {

/// One run: a system maps an environment once and answers the queries. Self-contained: everything
/// that determines the result is here or in the files that it names.
struct RunSpec {
  std::string name;  ///< unique in the suite, valid as a folder name: "semantic-exact-pepper-0"
  Environment environment;
  Level level;
  std::filesystem::path vocabulary;
  SystemSpec system;
  Labels labels;
  int trial = 0;
  std::uint64_t seed = 0;  ///< of the trial
  SharedSlamConfig slam;   ///< mapping settings; neutral for the plain system
  /// Settings of the queries, at least one: each gets a pass over all queries on the same map.
  std::vector<SemanticConfig> points;
  ProtocolConfig protocol;
  std::vector<Sense> senses = {};
  std::optional<GradedSpec> graded = {};
  std::optional<EpisodesSpec> episodes = {};  ///< run after the queries
  /// Labels of the frames of a run with episodes: the objects of the robot's map are made from
  /// them, even if the system sees no labels.
  Labels map_labels = {};
  std::optional<std::size_t> max_frames;
};

template <MaybeConst<RunSpec> S, class Visit>
void fields(S& spec, Visit& v) {
  auto& [name, environment, level, vocabulary, system, labels, trial, seed, slam, points, protocol,
         senses, graded, episodes, map_labels, max_frames] = spec;
  v("name", name);
  v("environment", environment);
  v("level", level);
  v("vocabulary", vocabulary);
  v("system", system);
  v("labels", labels);
  v("trial", trial);
  v("seed", seed);
  v("slam", slam);
  v("points", points);
  v("protocol", protocol);
  v("senses", senses);
  v("graded", graded);
  v("episodes", episodes);
  v("map_labels", map_labels);
  v("max_frames", max_frames);
}

/// Everything about a run, with paths unchanged: what its key is made of. The JSON keys are those
/// of the lists of fields (bench/suite/json_fields.hpp).
nlohmann::ordered_json to_json(const RunSpec& spec);

/// The inverse. @throws InputError if the JSON was not created by to_json.
RunSpec run_spec_from_json(const nlohmann::ordered_json& json);

/// The labels that the frames of a run are made with. A system without labels is shown none.
inline const Labels& labels_of_frames(const RunSpec& run) {
  return run.episodes ? run.map_labels : run.labels;
}

/// Settings as a system sees them: neutral semantics for the plain system, no settings for an
/// outside program.
SlamConfig settings_of(const SystemSpec& system, const SlamConfig& settings);

/// The parameter points of a suite: those of its sweep, otherwise its own settings only.
std::vector<SharedSlamConfig> parameter_points(const Suite& suite);

/// Returns every run, ordered by environment, level, trial, parameters, system, labels. The plain
/// system never uses labels (its own test checks this), so it runs once and is compared with every
/// kind of label. A parameter that a system ignores adds neither runs nor points for that system:
/// of a sweep's points, the plain system takes only those that differ in alpha or beta, and an
/// outside program takes none.
std::vector<RunSpec> expand(const Suite& suite);

}  // namespace mh
