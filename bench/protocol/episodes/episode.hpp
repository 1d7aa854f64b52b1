// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/protocol/episode_score.hpp"
#include "bench/protocol/episodes/robot_map.hpp"
#include "bench/protocol/episodes/starts.hpp"
#include "bench/protocol/system.hpp"
#include "sim/simulation/simulation.hpp"

namespace mh {

/// A contact faster than this is a collision.
inline constexpr double kCollision_m_per_s = 0.1;
/// A believed pose is false if its position or its angle is off by more than this.
inline constexpr double kFalsePose_m = 0.5, kFalsePose_deg = 20;

/// Where an episode is run, and with which robot and system.
struct EpisodePlace {
  SimulatedScene scene;
  const Robot& robot;
  const SensorConfig& level;
  LabelMode labels = LabelMode::kExact;
  bool system_sees_labels = true;
  const RobotMap& map;
  const System& frozen;
  std::uint32_t map_of_system = 0;  ///< TimedPose::map of the poses behind `map`
  SE3 truth_from_estimate;          ///< used for the score only
  std::string variant = "as_mapped";
  std::uint64_t system_seed = 0;  ///< of the SLAM system's draws
};

/// The state of an episode at one moment, for logs and images.
struct EpisodeMoment {
  double time_s = 0;
  const RgbdFrame* frame = nullptr;  ///< null if no frame arrived
  const SystemReport* report = nullptr;
  Pose2 world_from_base;                 ///< truth
  std::optional<Pose2> believed;         ///< in the world frame: `world_from_map` applied
  Pose2 world_from_map;                  ///< the robot's map aligned with the truth
  const Navigator* navigator = nullptr;  ///< null if the episode ended before it began
  std::vector<std::string> said = {};
};
using EpisodeObserver = std::function<void(const EpisodeMoment&)>;

/// The score of an episode before it begins: only where the robot is and what it must find are set.
EpisodeScore score_at_start(const std::string& variant, const EpisodeStart& start);

/// Kidnaps the robot: it is put at the start in the dark, the light is switched on, it looks
/// around, relocalizes, plans on its own map, and drives to the goal. Deterministic; the seed of
/// the sensor noise depends on the spec's seed, variant and start, not on the system.
EpisodeScore run_episode(const EpisodePlace& place, const EpisodesSpec& spec,
                         const EpisodeStart& start, const EpisodeObserver& observe = {});

}  // namespace mh
