// SPDX-License-Identifier: Apache-2.0
#include "robots/navigation/navigator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "robots/navigation/plan.hpp"
#include "robots/navigation/smooth.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr double kReplan_s = 1.0;
constexpr double kProgress_m = 0.10;
constexpr double kBackOff_s = 1.5, kBackOff_m_per_s = 0.08;
constexpr double kShown_m = 1.5;       // anything nearer is considered for braking
constexpr double kSamePlace_m = 0.10;  // a smaller difference does not count: path length decides
constexpr double kFaced_rad = 0.1;
constexpr double kBeforeThing_m = 0.1;
constexpr double kReachSlack_m = 0.3;  // distances to the goal are computed this far beyond reach_m

/// Whether a wall crosses the straight line between two places; what is within 10 cm of `to_m` does
/// not count, since objects are placed against walls.
/// @param walls  1 for cells of the grid that are walls; empty: no walls
bool wall_between(const FloorGrid& grid, const Grid2d<std::uint8_t>& walls, const Vector2d& from_m,
                  const Vector2d& to_m) {
  if (walls.empty()) return false;
  const double length_m = (to_m - from_m).norm();
  for (double at_m = 0; at_m < length_m - kBeforeThing_m; at_m += 0.5 * grid.resolution_m) {
    const auto cell = grid.cell_of(from_m + at_m / length_m * (to_m - from_m));
    if (cell && walls(cell->first, cell->second) != 0) return true;
  }
  return false;
}

}  // namespace

std::string_view name(NavigatorState state) {
  constexpr std::array<std::string_view, 10> kNames{"looking", "exploring", "planning", "driving",
                                                    "facing",  "backing",   "arrived",  "no_path",
                                                    "stuck",   "collided"};
  return kNames[static_cast<std::size_t>(state)];
}

Grid2d<float> distances_m(const KnownMap& map, std::span<const Vector2d> places_m, double reach_m) {
  constexpr float kBeyond = std::numeric_limits<float>::infinity();
  const FloorGrid& grid = map.grid;
  Grid2d<float> away_m(grid.clearance_m.width(), grid.clearance_m.height(), kBeyond);
  for (int y = 0; y < away_m.height(); ++y)
    for (int x = 0; x < away_m.width(); ++x) {
      if (map.blocked(x, y) != 0) continue;  // the robot cannot stand there
      const Vector2d place_m = grid.center_of({x, y});
      const Vector2d* nearest = nullptr;
      double nearest_m = reach_m;
      for (const Vector2d& goal : places_m)
        if (const double away = (goal - place_m).norm(); away <= nearest_m) {
          nearest_m = away;
          nearest = &goal;
        }
      if (nearest != nullptr && !wall_between(grid, map.walls, place_m, *nearest))
        away_m(x, y) = static_cast<float>(nearest_m);
    }
  return away_m;
}

std::optional<Vector2d> place_before(const FloorGrid& grid, const Grid2d<float>& away_m,
                                     const Vector2d& from_m, double clearance_m, double reach_m) {
  const auto start = nearest_clear(grid, from_m, clearance_m, 0.5);
  if (!start) return std::nullopt;
  const Grid2d<float> lengths = way_lengths(grid, *start, clearance_m);
  double nearest_m = reach_m;
  const auto visit = [&](auto&& use) {
    for (int y = 0; y < lengths.height(); ++y)
      for (int x = 0; x < lengths.width(); ++x)
        if (std::isfinite(lengths(x, y)))
          use(grid.center_of({x, y}), static_cast<double>(away_m(x, y)),
              static_cast<double>(lengths(x, y)));
  };
  visit([&](const Vector2d&, double away, double) { nearest_m = std::min(nearest_m, away); });
  std::optional<Vector2d> best;
  double best_m = std::numeric_limits<double>::infinity();
  visit([&](const Vector2d& place_m, double away, double length_m) {
    if (away > std::min(reach_m, nearest_m + kSamePlace_m) || length_m >= best_m) return;
    best_m = length_m;
    best = place_m;
  });
  return best;
}

const char* lacking_to_drive(const Robot& robot) {
  if (!robot.equipment || robot.equipment->lasers.empty()) return "lasers";
  return robot.equipment->wheels ? nullptr : "wheels";
}

Navigator::Navigator(const KnownMap& map, const Robot& robot, std::vector<NavigatorGoal> goals,
                     const NavigatorConfig& config)
    : map_(map), robot_(robot), goals_(std::move(goals)), config_(config), belief_(config.belief) {
  if (const char* part = lacking_to_drive(robot))
    throw InputError(
        fmt::format("robot '{}' has no {}: it cannot drive on its own (its file: equipment.{})",
                    robot.name, part, part));
  for (const NavigatorGoal& goal : goals_)
    if (aim_at(goal)) return;
  aim_at(goals_.front());
  throw InputError(fmt::format(
      "goal {} at [{:.2f}, {:.2f}] m: the robot cannot stand within {:.2f} m of it: it is inside a "
      "wall or in space that the map does not know",
      all_goals(), middle_m_.x(), middle_m_.y(), config.reach_m));
}

std::string Navigator::all_goals() const {
  const std::string first = fmt::format("'{}'", goals_.front().name);
  return goals_.size() == 1 ? first : fmt::format("{} (or {} more)", first, goals_.size() - 1);
}

bool Navigator::aim_at(const NavigatorGoal& goal) {
  name_ = goal.name;
  away_m_ = distances_m(map_, goal.places_m, config_.reach_m + kReachSlack_m);
  middle_m_ = Vector2d::Zero();
  for (const Vector2d& place : goal.places_m)
    middle_m_ += place / static_cast<double>(goal.places_m.size());
  const double clearance_m = robot_.footprint_radius_m + config_.least_margin_m;
  for (int y = 0; y < away_m_.height(); ++y)
    for (int x = 0; x < away_m_.width(); ++x)
      if (static_cast<double>(map_.grid.clearance_m(x, y)) >= clearance_m &&
          static_cast<double>(away_m_(x, y)) <= config_.reach_m)
        return true;
  return false;
}

double Navigator::away_from_goal_m(const Vector2d& place_in_map_m) const {
  const auto cell = map_.grid.cell_of(place_in_map_m);
  return cell ? static_cast<double>(away_m_(cell->first, cell->second))
              : std::numeric_limits<double>::infinity();
}

void Navigator::enter(NavigatorState state, double time_s) {
  state_ = state;
  since_s_ = time_s;
  turned_rad_ = 0;
  heading_before_.reset();
}

void Navigator::perceive(const Perception& now) {
  local_.add_lasers(*robot_.equipment, now.lasers_m, now.odom_from_base);
  if (!now.seen) return;
  if (now.seen->depth_m != nullptr)
    local_.add_depth(*now.seen->depth_m, robot_.camera, robot_.base_from_camera,
                     now.seen->odom_from_base);
  belief_.see(now.seen->map_from_base, now.seen->odom_from_base);
}

bool Navigator::touched(const Perception& now) {
  const Equipment& equipment = *robot_.equipment;
  Vector2d toward = Vector2d::Zero();
  for (std::size_t b = 0; b < std::min(now.bumpers.size(), equipment.bumpers.size()); ++b)
    if (now.bumpers[b])
      toward += equipment.base_from(equipment.bumpers[b]).translation().head<2>().normalized();
  if (toward.norm() < 1e-6) return false;
  toward.normalize();
  local_.add_contact(now.odom_from_base * Vector2d((robot_.footprint_radius_m + 0.02) * toward));
  away_ = -toward;
  if (robot_.differential() != nullptr) away_ = {std::copysign(1.0, away_.x()), 0};
  ++bumps_;
  say(fmt::format("touched something: bump {}", bumps_));
  enter(bumps_ > config_.most_bumps ? NavigatorState::kCollided : NavigatorState::kBacking,
        now.time_s);
  return true;
}

Twist2d Navigator::step(const Perception& now) {
  perceive(now);
  if (is_end(state_)) return Twist2d::Zero();
  if (state_ != NavigatorState::kBacking && touched(now)) return Twist2d::Zero();
  if (belief_.known() && !was_known_) {
    const Pose2 at = map_from_base(now.odom_from_base);
    say(fmt::format("knows its place in its map: [{:.2f}, {:.2f}] m, {:.0f} deg", at.place_m.x(),
                    at.place_m.y(), at.heading_rad * 180 / M_PI));
    if (state_ != NavigatorState::kBacking) enter(NavigatorState::kPlanning, now.time_s);
  }
  if (!belief_.known() && was_known_) {
    say("has lost its place: looks around");
    if (state_ != NavigatorState::kBacking) enter(NavigatorState::kLooking, now.time_s);
  }
  was_known_ = belief_.known();
  switch (state_) {
    case NavigatorState::kLooking:
      return look(now);
    case NavigatorState::kExploring:
      return explore(now);
    case NavigatorState::kPlanning:
      return plan(now);
    case NavigatorState::kDriving:
      return drive(now);
    case NavigatorState::kFacing:
      return face(now);
    case NavigatorState::kBacking:
      return back(now);
    default:
      return Twist2d::Zero();
  }
}

Twist2d Navigator::look(const Perception& now) {
  const double heading_rad = now.odom_from_base.heading_rad;
  if (heading_before_) turned_rad_ += turn_to(*heading_before_, heading_rad);
  heading_before_ = heading_rad;
  if (turned_rad_ < 2 * M_PI && now.time_s - since_s_ < 60)
    return {0, 0, std::min(config_.follow.turn_rad_per_s, robot_.limits.max_turn_rad_per_s)};
  if (belief_.known()) {  // not lost: it only looked around for another path
    enter(NavigatorState::kPlanning, now.time_s);
    return Twist2d::Zero();
  }
  looked_.push_back(now.odom_from_base.place_m);
  const auto way = way_to_look_around(local_.grid(), looked_, config_.lost);
  if (!way) {
    recover(now, "sees no free floor to drive on");
    return Twist2d::Zero();
  }
  path_ = smoothed(local_.grid(), *way, config_.lost.clearance_m);
  say(fmt::format("is lost: drives {:.1f} m to look around there", length_m(path_)));
  enter(NavigatorState::kExploring, now.time_s);
  least_left_m_ = length_m(path_);
  progress_s_ = now.time_s;
  return Twist2d::Zero();
}

Twist2d Navigator::explore(const Perception& now) {
  FollowConfig slower = config_.follow;
  slower.speed_m_per_s = config_.lost_speed_m_per_s;
  const std::vector<Vector2d> near = local_.obstacles_near(now.odom_from_base.place_m, kShown_m);
  const Steering steering = follow(path_, now.odom_from_base, near, robot_, slower);
  if (steering.left_m < least_left_m_ - kProgress_m) {
    least_left_m_ = steering.left_m;
    progress_s_ = now.time_s;
  }
  if (steering.arrived || now.time_s - progress_s_ > 0.5 * config_.patience_s) {
    say(steering.arrived ? "looks around" : "something is in its path: looks around here");
    enter(NavigatorState::kLooking, now.time_s);
    return Twist2d::Zero();
  }
  return steering.command;
}

FloorGrid Navigator::present_grid(const Pose2& map_from_base) const {
  FloorGrid grid = map_.grid;
  Grid2d<std::uint8_t> blocked = map_.blocked;
  const Pose2& map_from_odom = belief_.map_from_odom();
  const Vector2d here = (map_from_odom.inverse() * map_from_base).place_m;
  bool changed = false;
  for (const Vector2d& obstacle : local_.obstacles_near(here, 4.0)) {
    const auto cell = grid.cell_of(map_from_odom * obstacle);
    if (!cell || blocked(cell->first, cell->second) != 0) continue;
    blocked(cell->first, cell->second) = 1;
    changed = true;
  }
  if (changed) grid.clearance_m = clearances_m(blocked, grid.resolution_m);
  return grid;
}

bool Navigator::find_way(const Pose2& map_from_base) {
  const FloorGrid grid = present_grid(map_from_base);
  bool found = false;
  for (const double margin_m : {config_.margin_m, config_.least_margin_m}) {
    const double clearance_m = robot_.footprint_radius_m + margin_m;
    const auto place_m =
        place_before(grid, away_m_, map_from_base.place_m, clearance_m, config_.reach_m);
    if (!place_m) continue;
    const auto way = way_out(grid, map_from_base.place_m, *place_m, clearance_m);
    if (!way) continue;
    std::vector<Vector2d> path = smoothed(grid, *way, clearance_m);
    if (found && length_m(path) + config_.worth_margin_m > length_m(path_)) continue;
    path_ = std::move(path);
    found = true;
  }
  return found;
}

Twist2d Navigator::plan(const Perception& now) {
  const Pose2 at = map_from_base(now.odom_from_base);
  const bool found = std::ranges::any_of(
      goals_, [&](const NavigatorGoal& goal) { return aim_at(goal) && find_way(at); });
  if (!found) {
    const std::string why = fmt::format("finds no path to {}", all_goals());
    if (recoveries_ < 2) {
      recover(now, why);
    } else {
      say(why + ": gives up");
      enter(NavigatorState::kNoPath, now.time_s);
    }
    return Twist2d::Zero();
  }
  say(fmt::format("drives to {}: {:.1f} m", name_, length_m(path_)));
  enter(NavigatorState::kDriving, now.time_s);
  planned_s_ = progress_s_ = now.time_s;
  least_left_m_ = length_m(path_);
  return Twist2d::Zero();
}

Twist2d Navigator::drive(const Perception& now) {
  const Pose2 at = map_from_base(now.odom_from_base);
  if (now.time_s - planned_s_ >= kReplan_s) {
    planned_s_ = now.time_s;
    if (!find_way(at)) {
      recover(now, "its path is blocked");
      return Twist2d::Zero();
    }
  }
  std::vector<Vector2d> near = local_.obstacles_near(now.odom_from_base.place_m, kShown_m);
  for (Vector2d& place : near) place = belief_.map_from_odom() * place;
  const Steering steering = follow(path_, at, near, robot_, config_.follow);
  if (steering.left_m < least_left_m_ - kProgress_m) {
    least_left_m_ = steering.left_m;
    progress_s_ = now.time_s;
  }
  if (steering.arrived) {
    enter(NavigatorState::kFacing, now.time_s);
    return Twist2d::Zero();
  }
  if (now.time_s - progress_s_ > config_.patience_s) {
    recover(now, "makes no progress");
    return Twist2d::Zero();
  }
  return steering.command;
}

Twist2d Navigator::face(const Perception& now) {
  const Pose2 at = map_from_base(now.odom_from_base);
  const Vector2d to = middle_m_ - at.place_m;
  const double left_rad = turn_to(at.heading_rad, std::atan2(to.y(), to.x()));
  if (std::abs(left_rad) > kFaced_rad && now.time_s - since_s_ < 15)
    return turn_in_place(left_rad, robot_.limits, config_.follow, kFaced_rad);
  if (away_from_goal_m(at.place_m) > config_.reach_m) {
    recover(now, fmt::format("is not at {} after all", name_), false);
    return Twist2d::Zero();
  }
  say(fmt::format("has arrived at {}", name_));
  enter(NavigatorState::kArrived, now.time_s);
  return Twist2d::Zero();
}

Twist2d Navigator::back(const Perception& now) {
  if (now.time_s - since_s_ < kBackOff_s)
    return {kBackOff_m_per_s * away_.x(), kBackOff_m_per_s * away_.y(), 0};
  enter(belief_.known() ? NavigatorState::kPlanning : NavigatorState::kLooking, now.time_s);
  return Twist2d::Zero();
}

void Navigator::recover(const Perception& now, const std::string& why, bool forget) {
  if (++recoveries_ > config_.most_recoveries) {
    say(why + ": it is stuck and stops");
    enter(NavigatorState::kStuck, now.time_s);
    return;
  }
  say(why + (forget ? ": forgets what it saw and looks around" : ": looks around"));
  // The other goals come first now, in the same order as before.
  if (state_ == NavigatorState::kDriving || state_ == NavigatorState::kFacing)
    std::ranges::stable_partition(goals_, [&](const auto& goal) { return goal.name != name_; });
  if (forget) local_.clear();
  enter(NavigatorState::kLooking, now.time_s);
}

}  // namespace mh
