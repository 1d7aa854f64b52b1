// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/protocol/episodes/episode.hpp"
#include "bench/protocol/world/world.hpp"
#include "bench/suite/cache.hpp"
#include "bench/suite/run_spec.hpp"

namespace mh {

/// An episode to be watched, of the first variant.
struct WatchedEpisode {
  std::size_t start = 0;
  /// Makes the episode's observer; called once the robot has its map.
  std::function<EpisodeObserver(const RobotMap&, const EpisodeStart&)> observer;
};

/// What the episodes of a run receive in addition to its spec and world. `only` selects which ones
/// are run; no member changes a score.
struct EpisodeTools {
  /// Scores of episodes that have ended are kept here, so that an interrupted run does not repeat
  /// them.
  Cache ended = Cache();
  std::string key = {};  ///< of the run
  std::optional<WatchedEpisode> only = {};
  std::function<void()> require_unchanged = [] {};  ///< called before a score is kept; may throw
  std::function<void(std::string_view)> status = [](std::string_view) {};
  std::function<void()> done = [] {};  ///< called after each episode
};

/// Kidnaps a run's robot at each start of each variant, variant by variant. The robot's map is made
/// from the mapped frames at the estimated poses.
/// @param estimate             of the mapping
/// @param truth_from_estimate  used for the scores only
/// @param noise                of the mapped frames
/// @throws OutsideError
std::vector<EpisodeScore> ask_episodes(const RunSpec& spec, const World& world,
                                       const System& frozen, const Trajectory& estimate,
                                       const SE3& truth_from_estimate, RandomStream noise,
                                       const EpisodeTools& tools);

}  // namespace mh
