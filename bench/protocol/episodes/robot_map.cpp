// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/episodes/robot_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/occupancy/obstacle_grid.hpp"
#include "slam/occupancy/occupancy_mapper.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

/// The cells in which a wall was seen.
Grid2d<std::uint8_t> walls_of(const VoxelMap& map, const OccupancyGrid& grid) {
  const std::optional<ClassId> wall = class_by_name("wall");
  Grid2d<std::uint8_t> walls(grid.cells.width(), grid.cells.height());
  map.for_each([&](const Voxel& voxel) {
    if (!voxel.occupied || voxel.label != wall) return;
    const Eigen::Vector3d center = voxel.center_m(map.resolution_m());
    if (const auto cell = grid.cell_of(center.head<2>())) walls(cell->x(), cell->y()) = 1;
  });
  return walls;
}

/// Adds what the lasers saw at the chosen frames, at the estimated poses.
void add_lasers(const MapInput& input, const std::vector<std::size_t>& chosen,
                const SE3& map_from_estimate, OccupancyGrid& grid) {
  if (!input.lasers) return;
  ScanGrid scans(grid.resolution_m);
  auto pose = input.estimate.begin();
  for (const std::size_t i : chosen) {
    while (pose->stamp_ns < input.frames.stamp_ns(i)) ++pose;
    const SE3 map_from_base =
        map_from_estimate * pose->world_from_camera * input.robot.base_from_camera.inverse();
    add_scans(scans, *input.robot.equipment, map_from_base, input.lasers(i));
  }
  scans.add_to(grid);
}

}  // namespace

void add_scans(ScanGrid& scans, const Equipment& equipment, const SE3& map_from_base,
               std::span<const std::vector<float>> lasers_m) {
  for (std::size_t l = 0; l < equipment.lasers.size(); ++l) {
    const LaserScanner& laser = equipment.lasers[l];
    scans.add_scan(map_from_base * laser.base_from_laser,
                   {.first_angle_rad = -0.5 * laser.field_of_view_rad,
                    .angle_increment_rad = laser.field_of_view_rad / (laser.rays - 1),
                    .min_range_m = laser.min_range_m,
                    .max_range_m = laser.max_range_m,
                    .ranges_m = lasers_m[l]});
  }
}

KnownMap known_map(const VoxelMap& map, const OccupancyGrid& grid) {
  KnownMap known{.grid = {}, .blocked = blocked_cells(grid), .walls = walls_of(map, grid)};
  known.grid = floor_grid_of(known.blocked, grid.resolution_m, grid.center_m(0, 0));
  return known;
}

std::vector<std::vector<Vector2d>> footprints_of(const VoxelMap& map,
                                                 const std::vector<MapObject>& objects) {
  std::vector<std::set<std::pair<int, int>>> cells(objects.size());
  map.for_each([&](const Voxel& voxel) {
    if (!voxel.occupied || voxel.label == kVoid) return;
    const Eigen::Vector3d center = voxel.center_m(map.resolution_m());
    for (std::size_t i = 0; i < objects.size(); ++i)
      if (objects[i].class_id == voxel.label &&
          (center.array() >= objects[i].min_m.cast<double>().array()).all() &&
          (center.array() <= objects[i].max_m.cast<double>().array()).all())
        cells[i].emplace(voxel.index.x(), voxel.index.y());
  });
  std::vector<std::vector<Vector2d>> footprints(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const auto& [x, y] : cells[i])
      footprints[i].push_back(map.resolution_m() * Vector2d(x + 0.5, y + 0.5));
  return footprints;
}

std::vector<std::size_t> frames_for_map(const Sequence& frames, const Trajectory& estimate) {
  std::vector<std::size_t> chosen;
  std::optional<SE3> last;
  auto pose = estimate.begin();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    while (pose != estimate.end() && pose->stamp_ns < frames.stamp_ns(i)) ++pose;
    if (pose == estimate.end()) break;
    if (pose->stamp_ns != frames.stamp_ns(i)) continue;
    const SE3& now = pose->world_from_camera;
    if (last && (now.translation() - last->translation()).norm() < kViewMoved_m &&
        angle_between_rad(now, *last) < kViewTurned_rad)
      continue;
    chosen.push_back(i);
    last = now;
  }
  return chosen;
}

RobotMap build_robot_map(const MapInput& input) {
  RobotMap map;
  if (input.estimate.empty()) return map;
  map.map_from_estimate =
      input.robot.base_from_camera * input.estimate.front().world_from_camera.inverse();
  OccupancyMapper mapper(input.frames.camera());
  const std::vector<std::size_t> chosen = frames_for_map(input.frames, input.estimate);
  for (const std::size_t i : chosen) mapper.keep(input.frames.frame(i, input.noise));
  mapper.update(input.estimate, map.map_from_estimate);
  mapper.associate_detections();
  map.grid = obstacle_grid(mapper.map(), {.robot_height_m = input.robot.height_m});
  add_lasers(input, chosen, map.map_from_estimate, map.grid);
  if (std::ranges::count(map.grid.cells, kFreeCell) == 0) return {};
  map.objects = find_objects(mapper.map());
  map.footprints_m = footprints_of(mapper.map(), map.objects);
  map.known = known_map(mapper.map(), map.grid);
  return map;
}

std::vector<NavigatorGoal> goals_named(const RobotMap& map, const std::string& name) {
  std::vector<NavigatorGoal> goals;
  for (const std::size_t i : objects_named(map.objects, name))
    goals.push_back({map.objects[i].name, map.footprints_m[i]});
  return goals;
}

}  // namespace mh
