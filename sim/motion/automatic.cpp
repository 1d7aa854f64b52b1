// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/automatic.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "robots/navigation/plan.hpp"
#include "sim/motion/floor_grid.hpp"
#include "sim/motion/path.hpp"
#include "sim/motion/start.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr double kStray_m = 0.05;        // the robot stays within this distance of its path
constexpr double kLeastStray_m = 0.015;  // the limit in narrow places
constexpr double kSmallestFloor_m2 = 0.1;
constexpr double kSurvey_m_per_s = 0.35, kSurvey_rad_per_s = 0.6;  // the navigator's speeds

bool keeps_clear(const FloorGrid& grid, const RoundedPath& path, double clearance_m) {
  for (double s = 0; s < path.length_m(); s += 0.5 * grid.resolution_m)
    if (grid.clearance_at(path.at(s).position_m) < clearance_m) return false;
  return true;
}

/// Returns the path with extra points near each corner, so that the arc there reaches at most
/// `cut_m` on either side of the corner (RoundedPath cuts a corner by at most half a leg).
std::vector<Vector2d> narrowed(const std::vector<Vector2d>& way, double cut_m) {
  std::vector<Vector2d> result{way.front()};
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Vector2d leg = way[i] - way[i - 1];
    const double beside_m = std::min(2 * cut_m, leg.norm() / 3);
    if (i > 1) result.push_back(way[i - 1] + beside_m * leg.normalized());
    if (i + 1 < way.size()) result.push_back(way[i] - beside_m * leg.normalized());
    result.push_back(way[i]);
  }
  return result;
}

/// Returns a path that the robot can drive with its corners rounded, with as much clearance as
/// possible.
std::optional<std::vector<Vector2d>> drivable_way(const FloorGrid& grid, const Vector2d& from_m,
                                                  const Vector2d& to_m, const Robot& robot) {
  const double radius_m = robot.footprint_radius_m;
  for (const double stray_m : {kStray_m, kLeastStray_m}) {
    const auto way = plan_way(grid, from_m, to_m, radius_m + stray_m);
    if (!way) continue;
    // The tour prescribes the ends, which may be closer to obstacles than a path should be.
    for (const double cut_m : {1.0, 0.2, 0.1}) {
      const auto rounded = cut_m >= 1.0 ? *way : narrowed(*way, cut_m);
      if (way->size() < 3 ||
          keeps_clear(grid, RoundedPath(rounded, {.eased = robot.differential() != nullptr}),
                      radius_m))
        return rounded;
    }
    return narrowed(*way, 0.05);
  }
  return std::nullopt;
}

}  // namespace

Tour automatic_tour(const Scene& scene, const Robot& robot, const AutomaticTourConfig& config) {
  const FloorGrid grid = make_floor_grid(scene, {.top_m = robot.height_m});
  const double cell_m2 = grid.resolution_m * grid.resolution_m;
  for (const double stray_m : {0.10, kStray_m, kLeastStray_m}) {
    const double clearance_m = robot.footprint_radius_m + stray_m;
    const auto region = largest_region(grid, clearance_m);
    if (static_cast<double>(std::ranges::count(region, 1)) * cell_m2 < kSmallestFloor_m2) continue;
    const auto places = spread_places(grid, region, config.apart_m, config.places, config.seed);
    const auto order = round_trip(lengths_between(grid, places, clearance_m), places.size()).order;
    Tour tour;
    tour.name = fmt::format("{}:{}", config.survey ? "survey" : "auto", config.seed);
    tour.file = tour.name;
    tour.start_m = places.front();
    if (config.survey) {  // so that a camera at 10 Hz can follow
      tour.max_velocity_m_per_s = kSurvey_m_per_s;
      tour.max_turn_rad_per_s = kSurvey_rad_per_s;
    }
    tour.start_heading_rad = RandomStream(config.seed).uniform(1, -M_PI, M_PI);
    constexpr double kAround_rad = 2 * M_PI;
    tour.waypoints.push_back({.position_m = tour.start_m, .turn_rad = kAround_rad});
    for (std::size_t i = 1; i < order.size(); ++i)
      tour.waypoints.push_back(
          {.position_m = places[order[i]], .turn_rad = config.survey ? kAround_rad : 0.0});
    if (order.size() > 1) tour.waypoints.push_back({.position_m = tour.start_m});
    // Ends at the start with the initial heading, so that what was seen first is seen again.
    tour.waypoints.push_back(
        {.position_m = tour.start_m, .heading_rad = tour.start_heading_rad, .pause_s = 0.5});
    return planned(scene, robot, tour);
  }
  throw InputError(fmt::format("{}: has no free floor for a robot of {:.2f} m radius", scene.name,
                               robot.footprint_radius_m));
}

Tour planned(const Scene& scene, const Robot& robot, const Tour& tour) {
  const FloorGrid grid = make_floor_grid(scene, {.top_m = robot.height_m});
  Tour result = tour;
  result.plan = false;
  result.waypoints.clear();
  Vector2d here_m = tour.start_m;
  for (std::size_t i = 0; i < tour.waypoints.size(); ++i) {
    const Waypoint& goal = tour.waypoints[i];
    if ((goal.position_m - here_m).norm() > grid.resolution_m) {
      const auto way = drivable_way(grid, here_m, goal.position_m, robot);
      if (!way) {
        const std::string outside = outside_rooms(scene, goal.position_m);
        throw InputError(fmt::format(
            "{}: waypoint {}: [{:.2f}, {:.2f}] cannot be reached{}: no path from [{:.2f}, {:.2f}] "
            "is wide enough for a robot of {:.2f} m radius",
            file_and_line(tour.file, goal.line), i + 1, goal.position_m.x(), goal.position_m.y(),
            !outside.empty()
                ? outside
                : occupant_near(grid, scene, goal.position_m, robot.footprint_radius_m),
            here_m.x(), here_m.y(), robot.footprint_radius_m));
      }
      for (std::size_t k = 1; k + 1 < way->size(); ++k) {
        Waypoint passage;
        passage.position_m = (*way)[k];
        passage.look_at_m = goal.look_at_m;
        passage.line = goal.line;
        result.waypoints.push_back(passage);
      }
    }
    result.waypoints.push_back(goal);
    here_m = goal.position_m;
  }
  return result;
}

}  // namespace mh
