// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/episodes/starts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "robots/navigation/lost.hpp"
#include "robots/navigation/plan.hpp"
#include "sim/motion/floor_grid.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr double kClear_m = 0.05;     // clearance around a robot that is put down
constexpr double kSqueeze_m = 0.015;  // clearance around a robot on the shortest path
constexpr double kLeast_m = 0.5;      // a shorter path is not a search

bool is_search(double way_m) {
  return std::isfinite(way_m) && way_m >= kLeast_m;
}

/// Length (m) of the shortest path from each cell to a place that counts as arrival.
Grid2d<float> ways_to(const EpisodeStart& goal, const FloorGrid& grid, double arrival_m,
                      double clearance_m) {
  std::vector<Vector2d> ends;
  for (int y = 0; y < grid.clearance_m.height(); ++y)
    for (int x = 0; x < grid.clearance_m.width(); ++x) {
      const Vector2d place_m = grid.center_of({x, y});
      if (static_cast<double>(grid.clearance_m(x, y)) >= clearance_m &&
          is_arrival(goal, place_m, arrival_m))
        ends.push_back(place_m);
    }
  return way_lengths(grid, ends, clearance_m);
}

/// Centers of the cells where a robot can be put down, all reachable from each other.
std::vector<Vector2d> cells_to_stand_in(const FloorGrid& grid, const Scene& scene,
                                        const Robot& robot) {
  const Grid2d<std::uint8_t> region = largest_region(grid, robot.footprint_radius_m + kClear_m);
  std::vector<Vector2d> cells;
  for (int y = 0; y < region.height(); ++y)
    for (int x = 0; x < region.width(); ++x)
      if (region(x, y) != 0) cells.push_back(grid.center_of({x, y}));
  if (cells.empty())
    throw InputError(fmt::format("{}: there is no floor for the robot", scene.name));
  return cells;
}

Vector2d nearest_in(const TrueBox& box, const Vector2d& place_m) {
  return place_m.cwiseMax(box.first).cwiseMin(box.second);
}

}  // namespace

double distance_to(const std::vector<TrueBox>& boxes, const Vector2d& place_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const TrueBox& box : boxes)
    nearest_m = std::min(nearest_m, (place_m - nearest_in(box, place_m)).norm());
  return nearest_m;
}

bool is_arrival(const EpisodeStart& start, const Vector2d& place_m, double arrival_m) {
  return std::ranges::any_of(start.boxes, [&](const TrueBox& box) {
    const Vector2d to_m = nearest_in(box, place_m);
    return (place_m - to_m).norm() <= arrival_m && !start.walls->between(place_m, to_m);
  });
}

StandingPlace draw_place(const Scene& scene, const Robot& robot, RandomStream draw) {
  const FloorGrid grid = make_floor_grid(scene, {.top_m = robot.height_m});
  const std::vector<Vector2d> cells = cells_to_stand_in(grid, scene, robot);
  return {cells[draw.below(0, cells.size())], draw.uniform(1, -std::numbers::pi, std::numbers::pi)};
}

std::vector<EpisodeStart> draw_starts(const EpisodesSpec& spec, const Scene& scene,
                                      const Robot& robot) {
  const FloorGrid grid = make_floor_grid(scene, {.top_m = robot.height_m});
  const auto walls = std::make_shared<const TrueWalls>(scene, robot.height_m);
  const std::vector<Vector2d> cells = cells_to_stand_in(grid, scene, robot);

  struct Goal {
    EpisodeStart start;  ///< without its place
    Grid2d<float> way_m;
  };
  const auto way_from = [&grid](const Goal& goal, const Vector2d& place_m) {
    const auto cell = grid.cell_of(place_m);
    return static_cast<double>(goal.way_m(cell->first, cell->second));
  };
  std::vector<Goal> goals;
  for (const std::string& name : spec.goals) {
    const std::optional<ClassId> id = class_by_name(name);
    Goal goal{.start = {.goal = name, .walls = walls}, .way_m = {}};
    for (const Instance& instance : scene.instances)
      if (id && instance.class_id == *id)
        goal.start.boxes.emplace_back(instance.min_m.head<2>().cast<double>(),
                                      instance.max_m.head<2>().cast<double>());
    if (goal.start.boxes.empty()) continue;
    goal.way_m = ways_to(goal.start, grid, spec.arrival_m, robot.footprint_radius_m + kSqueeze_m);
    if (std::ranges::any_of(cells,
                            [&](const Vector2d& at) { return is_search(way_from(goal, at)); }))
      goals.push_back(std::move(goal));
  }
  if (goals.empty())
    throw InputError(fmt::format(
        "{}: has none of the goals where the robot can reach it and must drive at least {} m: {}",
        scene.name, kLeast_m, fmt::join(spec.goals, ", ")));

  std::vector<EpisodeStart> starts;
  const RandomStream stream = RandomStream(spec.seed).fork(0x73746172);
  for (std::size_t i = 0; i < spec.starts; ++i) {
    const RandomStream draw = stream.fork(i);
    const Goal& goal = goals[draw.below(0, goals.size())];
    EpisodeStart start = goal.start;
    start.index = i;
    start.heading_rad = draw.uniform(1, -std::numbers::pi, std::numbers::pi);
    std::uint64_t k = 2;
    do {
      start.place_m = cells[draw.below(k++, cells.size())];
      start.shortest_m = way_from(goal, start.place_m);
    } while (!is_search(start.shortest_m));
    starts.push_back(std::move(start));
  }
  return starts;
}

}  // namespace mh
