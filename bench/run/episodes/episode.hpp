// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/protocol/system.hpp"
#include "bench/run/episodes/robot_map.hpp"
#include "bench/run/episodes/starts.hpp"
#include "sim/world/simulation.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/fields.hpp"

namespace mh {

/// What came of one kidnapping, by the truth.
struct EpisodeScore {
  std::string variant = {};
  std::size_t start = 0;
  std::string goal = {};
  double start_x_m = 0, start_y_m = 0, start_heading_deg = 0;
  bool success = false;  ///< it said "arrived", and was within arrival_m of such a thing
  /// Empty for a success, else: no_map, never_relocalized, false_pose, object_not_in_map, no_path,
  /// stuck, collision_stop, time_out, wrong_arrival; of an outside system also system_failed, and
  /// not_run: it had failed before.
  std::string reason = {};
  bool said_arrived = false;
  bool wrong_arrival = false;                  ///< said so, and was not
  double time_s = 0;                           ///< until it stopped for good
  std::optional<double> located_s = {};        ///< when it first believed to know its place
  std::optional<double> located_error_m = {};  ///< of that belief
  std::optional<double> located_error_deg = {};
  std::optional<double> last_error_m = {};  ///< of its belief at the end
  double length_m = 0, shortest_m = 0;
  double spl = 0;             ///< success * shortest / max(shortest, driven): Anderson et al., 2018
  double end_distance_m = 0;  ///< from the nearest such thing
  int contacts = 0, collisions = 0;  ///< collisions: faster than 0.1 m/s
  double worst_contact_m_per_s = 0;
  int frames = 0;
  std::uint64_t digest = 0;  ///< of all that was seen, answered and commanded
};

template <MaybeConst<EpisodeScore> S, class Visit>
void fields(S& score, Visit& v) {
  auto& [variant, start, goal, start_x_m, start_y_m, start_heading_deg, success, reason,
         said_arrived, wrong_arrival, time_s, located_s, located_error_m, located_error_deg,
         last_error_m, length_m, shortest_m, spl, end_distance_m, contacts, collisions,
         worst_contact_m_per_s, frames, digest] = score;
  v("variant", variant);
  v("start", start);
  v("goal", goal);
  v("start_x_m", start_x_m);
  v("start_y_m", start_y_m);
  v("start_heading_deg", start_heading_deg);
  v("success", success);
  v("reason", reason);
  v("said_arrived", said_arrived);
  v("wrong_arrival", wrong_arrival);
  v("time_s", time_s);
  v("located_s", located_s);
  v("located_error_m", located_error_m);
  v("located_error_deg", located_error_deg);
  v("last_error_m", last_error_m);
  v("length_m", length_m);
  v("shortest_m", shortest_m);
  v("spl", spl);
  v("end_distance_m", end_distance_m);
  v("contacts", contacts);
  v("collisions", collisions);
  v("worst_contact_m_per_s", worst_contact_m_per_s);
  v("frames", frames);
  v("digest", as_digest(digest));
}

/// A contact faster than this is a collision.
inline constexpr double kCollision_m_per_s = 0.1;
/// A belief farther off than this, or turned by more, is false.
inline constexpr double kFalsePose_m = 0.5, kFalsePose_deg = 20;

/// Where and with what an episode is run. Everything is only read, except by sessions of outside
/// systems: of these, one episode at a time.
struct EpisodePlace {
  SimulatedScene scene;
  const Robot& robot;
  const SensorConfig& level;
  LabelMode labels = LabelMode::kExact;
  bool system_sees_labels = true;
  const RobotMap& map;
  const System& frozen;
  SE3 truth_from_estimate;  ///< for the score alone
  std::string variant = "as_mapped";
  std::uint64_t system_seed = 0;  ///< of the SLAM system's draws
};

/// One moment of an episode, for logs and images.
struct EpisodeMoment {
  double time_s = 0;
  const RgbdFrame* frame = nullptr;  ///< null if none arrived
  const SystemReport* report = nullptr;
  Pose2 world_from_base;                 ///< truth
  std::optional<Pose2> believed;         ///< world, as the truth aligns the robot's map
  Pose2 world_from_map;                  ///< the same alignment
  const Navigator* navigator = nullptr;  ///< null if the episode ended before it began
  std::vector<std::string> said = {};
};
using EpisodeObserver = std::function<void(const EpisodeMoment&)>;

/// Scores of an episode before it begins: where the robot is, what it is to find.
EpisodeScore score_at_start(const std::string& variant, const EpisodeStart& start);

/// Kidnaps the robot: it is put at the start in the dark, the light goes on, it looks around,
/// relocalizes, plans on its own map, and drives to the goal. Deterministic; what it sees depends
/// on seed, variant and start, not on the system.
EpisodeScore run_episode(const EpisodePlace& place, const EpisodesSpec& spec,
                         const EpisodeStart& start, const EpisodeObserver& observe = {});

}  // namespace mh
