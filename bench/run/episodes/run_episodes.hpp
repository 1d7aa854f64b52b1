// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/run/episodes/place.hpp"
#include "bench/suite/suite.hpp"

namespace mh {

/// The episodes of one run: one system in one environment at one level.
struct EpisodeRun {
  RunSpec spec;
  std::string key;
  std::vector<EpisodeScore> scores;  ///< by variant as in the suite, then by start
  std::string failure = {};  ///< of an outside system; the episodes that it missed are not stored
};

struct EpisodeOptions {
  std::filesystem::path out;  ///< exists; receives episodes.sqlite
  int jobs = 1;               ///< episodes at a time; never changes a result
  /// For light and finished maps; nullopt: nothing is kept.
  std::optional<std::filesystem::path> cache;
  std::optional<std::size_t> starts;  ///< fewer than the suite's: the first ones, for a quick look
  std::function<void(std::string_view)> say = [](std::string_view) {};
  /// Share of all episodes that are done, in [0, 1].
  std::function<void(double)> progress = [](double) {};
};

/// Runs of a suite with episodes, without their results: for each environment, level and system;
/// labels are the suite's first kind, which makes the objects of every system's map.
/// @throws InputError if the suite has no episodes.
std::vector<RunSpec> episode_runs(const Suite& suite);

/// The same run with the labels that its place is simulated with.
RunSpec labeled(RunSpec run, const Suite& suite);

/// Runs all episodes of a suite that are not in options.out / "episodes.sqlite" yet; each is stored
/// as soon as it has ended.
/// @throws InputError if an input is bad.
std::vector<EpisodeRun> run_episodes(const Suite& suite, const EpisodeOptions& options);

/// The world of one run and its system's map, for one episode. @param key  of the run
struct OneEpisode {
  EpisodeWorld world;
  MappedSystem mapped;
};
OneEpisode prepare_episode(const Suite& suite, const RunSpec& run, const EpisodeOptions& options);

/// What an episode of a variant is run with.
EpisodePlace episode_place(const RunSpec& run, const EpisodeWorld& world,
                           const VariantPlace& variant, const MappedSystem& mapped);

}  // namespace mh
