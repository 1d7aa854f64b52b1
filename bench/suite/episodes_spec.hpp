// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/suite/environment.hpp"
#include "slam/io/setting.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// How the world in which the robot is kidnapped differs from the one that it mapped.
struct EpisodeVariant {
  std::string name = "as_mapped";  ///< unique, valid as a folder name
  std::optional<std::filesystem::path> scene = {}, pedestrian = {}, level = {};
  friend bool operator==(const EpisodeVariant&, const EpisodeVariant&) = default;
};

/// Lists the sources of a variant: visit(WorldSource, optional path).
template <MaybeConst<EpisodeVariant> V, class Visit>
void sources(V& variant, Visit&& visit) {
  using enum SourceKind;
  visit(WorldSource{"scene", kScene, "a different scene: furniture moved, evening light", false,
                    true},
        variant.scene);
  visit(WorldSource{"pedestrian", kPedestrian, "present during the episodes", false, true},
        variant.pedestrian);
  visit(WorldSource{"level", kLevel, "for the robot's camera"}, variant.level);
}

template <MaybeConst<EpisodeVariant> V, class Visit>
void fields(V& variant, Visit& v) {
  v("name", variant.name);
  sources(variant, [&](const WorldSource& source, auto& path) { v(source.key, path); });
}

/// Name of a variant's source among the inputs of a run: "variant moved: scene".
inline std::string input_name(const EpisodeVariant& variant, const WorldSource& source) {
  return "variant " + variant.name + ": " + source.key;
}

/// Kidnappings of a robot, as data: the same starts for every system (docs/navigation.md).
struct EpisodesSpec {
  std::vector<std::string> goals;
  std::size_t starts = 10;
  std::uint64_t seed = 0;
  double limit_s = 240;
  double arrival_m = 1.0;
  int ticks_per_frame = 3;
  double dark_s = 1.0;
  std::vector<EpisodeVariant> variants = {{}};
  std::size_t count() const { return variants.size() * starts; }
  friend bool operator==(const EpisodesSpec&, const EpisodesSpec&) = default;
};

/// Lists all members but the variants, that is, the section's single values.
template <MaybeConst<EpisodesSpec> E, class Visit>
void episode_settings(E& episodes, Visit& v) {
  auto& [goals, starts, seed, limit_s, arrival_m, ticks_per_frame, dark_s, variants] = episodes;
  v("goals", goals, setting::required({}), "classes; each start draws one that the scene has");
  v("starts", starts, {1, 100000}, "starts of each variant in each environment");
  v("seed", seed, setting::kSeed, "seed of starts and noise");
  v("limit_s", limit_s, {1, 3600}, "simulated time of an episode");
  v("arrival_m", arrival_m, {0.5, 10},
    "success: the robot's center is at most this far from the object");
  v("ticks_per_frame", ticks_per_frame, {1, 60},
    "ticks of the camera's 30 Hz per frame: 3 gives 10 Hz");
  v("dark_s", dark_s, {0, 60}, "time of blank frames at the start; less than limit_s");
}

template <MaybeConst<EpisodesSpec> E, class Visit>
void fields(E& episodes, Visit& v) {
  episode_settings(episodes, v);
  v("variants", episodes.variants);
}

/// Reads the section `episodes` of a suite.
/// @throws InputError naming file, line, field and value: a goal that is not a class (with
/// suggestions), two variants with the same name, a missing file.
EpisodesSpec read_episodes(YamlReader node, const SuitePaths& paths);

}  // namespace mh
