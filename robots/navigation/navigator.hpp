// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "robots/model/robot.hpp"
#include "robots/navigation/belief.hpp"
#include "robots/navigation/follow.hpp"
#include "robots/navigation/grid.hpp"
#include "robots/navigation/lost.hpp"
#include "robots/navigation/near_map.hpp"

namespace mh {

/// What a robot knows about a place that it has mapped.
struct KnownMap {
  FloorGrid grid;                ///< clearance; what is unknown is blocked
  Grid2d<std::uint8_t> blocked;  ///< for the same cells: occupied or unknown
  Grid2d<std::uint8_t> walls;    ///< for the same cells: known walls; empty: no walls are known
};

/// A goal: an object in the robot's own map, seen from above.
struct NavigatorGoal {
  std::string name;                       ///< name for the navigator's messages
  std::vector<Eigen::Vector2d> places_m;  ///< centers of the cells that it covers, map frame
};

struct NavigatorConfig {
  FollowConfig follow;
  LostConfig lost;
  BeliefConfig belief;
  double lost_speed_m_per_s = 0.25;  ///< while it does not know where it is
  // Clearances of the robot's center beyond its radius: the desired one and the minimum.
  double margin_m = 0.08, least_margin_m = 0.03;
  double worth_margin_m = 1.0;  ///< detour accepted for the desired margin instead of the minimum
  double reach_m = 0.9;         ///< it has arrived if the goal is no farther than this
  double patience_s = 10;       ///< time without progress after which it gives up a path
  int most_recoveries = 4, most_bumps = 3;
};

/// What the robot perceives at one time, without ground truth.
struct Perception {
  double time_s = 0;
  Pose2 odom_from_base;
  std::span<const std::vector<float>> lasers_m;
  std::vector<bool> bumpers;
  /// A frame, with the odometry at its stamp.
  struct Seen {
    const Grid2d<float>* depth_m = nullptr;  ///< null: the frame is blank
    Pose2 odom_from_base;
    std::optional<Pose2> map_from_base;  ///< the SLAM system's answer to it
  };
  std::optional<Seen> seen;
};

enum class NavigatorState {
  kLooking,    ///< lost: turns in place
  kExploring,  ///< lost: drives to where it will look around next
  kPlanning,
  kDriving,
  kFacing,   ///< turns toward the goal at the end of its path
  kBacking,  ///< drives away from what it touched
  // Final states: the robot stands still.
  kArrived,
  kNoPath,
  kStuck,
  kCollided,
};
std::string_view name(NavigatorState state);
inline bool is_end(NavigatorState state) {
  return state >= NavigatorState::kArrived;
}

/// What a robot lacks to drive on its own: "lasers" or "wheels" (odometry); nullptr if it lacks
/// neither. Without bumpers it does not notice what it touches.
const char* lacking_to_drive(const Robot& robot);

/// Drives a robot to a place of its own map, from wherever it was put: looks around until it knows
/// where it is, plans over the map and what its sensors show, follows the path, stops for
/// obstacles, and reports when it has arrived, is stuck or gives up. It receives what the robot
/// measures and what its SLAM system answers, nothing else: its library links neither scenes nor
/// the simulator.
class Navigator {
 public:
  /// @param map    must outlive this
  /// @param robot  must outlive this
  /// @param goals  at least one, with different names; it drives to the first that a path leads to,
  ///               and retries one that it could not reach only after the others
  /// @throws InputError if the robot has no lasers or wheels, or no goal is within reach of any
  /// free place of the map.
  Navigator(const KnownMap& map, const Robot& robot, std::vector<NavigatorGoal> goals,
            const NavigatorConfig& config = {});

  /// The command until the next step (base frame).
  Twist2d step(const Perception& now);

  NavigatorState state() const { return state_; }
  bool knows_its_place() const { return belief_.known(); }
  /// Its estimated pose. @pre knows_its_place()
  Pose2 map_from_base(const Pose2& odom_from_base) const {
    return belief_.map_from_odom() * odom_from_base;
  }
  /// The path that it follows, in the map if it is located, else in the odometry's frame.
  const std::vector<Eigen::Vector2d>& path() const { return path_; }
  /// Its decisions since the last call, one line per decision.
  std::vector<std::string> take_said() { return std::exchange(said_, {}); }

 private:
  void say(std::string_view text) { said_.emplace_back(text); }
  void enter(NavigatorState state, double time_s);
  void perceive(const Perception& now);
  Twist2d look(const Perception& now);
  Twist2d explore(const Perception& now);
  Twist2d plan(const Perception& now);
  Twist2d drive(const Perception& now);
  Twist2d face(const Perception& now);
  Twist2d back(const Perception& now);
  bool touched(const Perception& now);
  /// The map with what the sensors show now.
  FloorGrid present_grid(const Pose2& map_from_base) const;
  /// Makes this the current goal; false if the robot cannot stand within reach of the goal anywhere
  /// in the map.
  bool aim_at(const NavigatorGoal& goal);
  bool find_way(const Pose2& map_from_base);
  std::string all_goals() const;
  /// Looks around and plans again. @param forget also forgets what the sensors showed, which may be
  /// wrong
  void recover(const Perception& now, const std::string& why, bool forget = true);
  double away_from_goal_m(const Eigen::Vector2d& place_in_map_m) const;

  const KnownMap& map_;
  const Robot& robot_;
  std::vector<NavigatorGoal> goals_;
  NavigatorConfig config_;
  // The current goal: its name, the distance of each cell of the map from it, its center.
  std::string name_;
  Grid2d<float> away_m_;
  Eigen::Vector2d middle_m_ = Eigen::Vector2d::Zero();
  NearMap local_;
  PlaceBelief belief_;
  NavigatorState state_ = NavigatorState::kLooking;
  std::vector<std::string> said_;
  std::vector<Eigen::Vector2d> path_;
  std::vector<Eigen::Vector2d> looked_;  ///< where it has turned, odometry's frame
  double since_s_ = 0;                   ///< when the state was entered
  double turned_rad_ = 0;
  std::optional<double> heading_before_;
  Eigen::Vector2d away_ = Eigen::Vector2d::Zero();  ///< direction from what it touched; base frame
  double planned_s_ = 0, progress_s_ = 0, least_left_m_ = 0;
  int recoveries_ = 0, bumps_ = 0;
  bool was_known_ = false;
};

/// Distance (m) of each cell of a map from the nearest of some places, infinite in blocked cells,
/// beyond `reach_m`, and where a wall is in between: standing behind a wall is not arrival.
Grid2d<float> distances_m(const KnownMap& map, std::span<const Eigen::Vector2d> places_m,
                          double reach_m);

/// The best place of a map to stand in front of a thing: the nearest to it or, among equally near
/// ones, the one with the shortest path; nullopt if no path from `from_m` leads to a place within
/// `reach_m` of the thing.
/// @param away_m  distance of each cell from the thing
std::optional<Eigen::Vector2d> place_before(const FloorGrid& grid, const Grid2d<float>& away_m,
                                            const Eigen::Vector2d& from_m, double clearance_m,
                                            double reach_m);

}  // namespace mh
