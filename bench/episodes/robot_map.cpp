// SPDX-License-Identifier: Apache-2.0
#include "bench/episodes/robot_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/occupancy/obstacle_grid.hpp"
#include "slam/occupancy/occupancy_mapper.hpp"

namespace mh {
namespace {

// A view tells the map something new after so much: at 2 m, 0.26 rad are half a meter.
constexpr double kMoved_m = 0.25, kTurned_rad = 0.26;

KnownMap known_map(const OccupancyGrid& grid, const std::vector<MapObject>& objects) {
  KnownMap known;
  known.grid.resolution_m = grid.resolution_m;
  known.grid.origin_m = grid.center_m(0, 0);
  const int w = grid.cells.width(), h = grid.cells.height();
  known.blocked = Grid2d<std::uint8_t>(w, h);
  known.occupied = Grid2d<std::uint8_t>(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      known.blocked(x, y) = grid.cells(x, y) != kFreeCell;
      known.occupied(x, y) = grid.cells(x, y) == kOccupiedCell;
    }
  known.grid.clearance_m = clearances_m(known.blocked, grid.resolution_m);
  known.grid.occupant = Grid2d<std::uint16_t>(w, h);
  for (const MapObject& object : objects)
    known.things.push_back({object.name, object.min_m.head<2>().cast<double>(),
                            object.max_m.head<2>().cast<double>(), object.score});
  return known;
}

}  // namespace

std::vector<std::size_t> frames_for_map(const Sequence& frames, const Trajectory& estimate) {
  std::vector<std::size_t> chosen;
  std::optional<SE3> last;
  auto pose = estimate.begin();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    while (pose != estimate.end() && pose->stamp_ns < frames.stamp_ns(i)) ++pose;
    if (pose == estimate.end()) break;
    if (pose->stamp_ns != frames.stamp_ns(i)) continue;
    const SE3& now = pose->world_from_camera;
    if (last && (now.translation() - last->translation()).norm() < kMoved_m &&
        angle_between_rad(now, *last) < kTurned_rad)
      continue;
    chosen.push_back(i);
    last = now;
  }
  return chosen;
}

RobotMap build_robot_map(const Sequence& frames, const Trajectory& estimate, const Robot& robot,
                         RandomStream noise) {
  if (estimate.empty()) throw InputError("the system tracked no frame: there is no map");
  RobotMap map;
  map.map_from_estimate = robot.base_from_camera * estimate.front().world_from_camera.inverse();
  OccupancyMapper mapper(frames.camera());
  for (const std::size_t i : frames_for_map(frames, estimate)) mapper.keep(frames.frame(i, noise));
  mapper.update(estimate, map.map_from_estimate);
  map.grid = obstacle_grid(mapper.map(), {.robot_height_m = robot.height_m});
  if (std::ranges::count(map.grid.cells, kFreeCell) == 0)
    throw InputError("the map shows no free floor: its frames have no depth");
  map.objects = find_objects(mapper.map());
  map.known = known_map(map.grid, map.objects);
  return map;
}

NavigatorGoal goal_named(const RobotMap& map, const std::string& name) {
  const MapObject& object = map.objects[objects_named(map.objects, name).front()];
  return {object.name, object.min_m.head<2>().cast<double>(),
          object.max_m.head<2>().cast<double>()};
}

}  // namespace mh
