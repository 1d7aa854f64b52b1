// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/map_score.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace mh {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

bool has_near(const VoxelMap& map, const Vector3i& voxel, VoxelState state) {
  const double r = map.resolution_m();
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const Vector3d center = r * ((voxel + Vector3i(x, y, z)).cast<double>().array() + 0.5);
        if (map.state_at(center) == state) return true;
      }
  return false;
}

std::int8_t cell_at(const OccupancyGrid& grid, const Eigen::Vector2d& place_m) {
  const auto cell = grid.cell_of(place_m);
  return cell ? grid.cells(cell->x(), cell->y()) : kUnknownCell;
}

}  // namespace

VoxelScore score_voxels(const VoxelMap& map, const VoxelMap& exact, const TrueSpace& truth) {
  using State = TrueSpace::State;
  VoxelScore score;
  map.for_each([&](const Voxel& voxel) {
    if (voxel.occupied) {
      score.occupied_precision.add(truth.is_near(voxel.index, State::kSurface));
      return;
    }
    score.free_precision.add(truth.at(voxel.index) == State::kOpen);
    score.free_within_one.add(truth.is_near(voxel.index, State::kOpen));
  });
  exact.for_each([&](const Voxel& voxel) {
    const State state = truth.at(voxel.index);
    if (voxel.hits > 0 && state == State::kSurface)
      score.occupied_recall.add(has_near(map, voxel.index, VoxelState::kOccupied));
    if (voxel.hits == 0 && voxel.misses > 0 && state == State::kOpen)
      score.free_recall.add(map.state_at(voxel.center_m(map.resolution_m())) == VoxelState::kFree);
  });
  return score;
}

GridScore score_grid(const OccupancyGrid& grid, const OccupancyGrid& plan) {
  GridScore score;
  const auto add = [&](bool in_grid, bool in_plan, bool known) {
    if (!in_grid && !in_plan) return;
    score.iou.add(in_grid && in_plan);
    if (known) score.iou_seen.add(in_grid && in_plan);
  };
  for (int y = 0; y < plan.cells.height(); ++y)
    for (int x = 0; x < plan.cells.width(); ++x) {
      const std::int8_t mapped = cell_at(grid, plan.center_m(x, y));
      add(mapped == kFreeCell, plan.cells(x, y) == kFreeCell, mapped != kUnknownCell);
    }
  return score;
}

ObjectScore score_objects(const std::vector<MapObject>& found, const Scene& scene, double least_m,
                          double reach_m) {
  ObjectScore score;
  for (const Instance& instance : scene.instances) {
    const Vector3d low = instance.min_m.cast<double>(), high = instance.max_m.cast<double>();
    if (is_thing(instance.class_id))
      score.objects.push_back({.name = instance.name,
                               .class_id = instance.class_id,
                               .center_m = 0.5 * (low + high),
                               .size_m = high - low});
  }
  // Pairs true and found objects, the nearest first; each object is in at most one pair.
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t t = 0; t < score.objects.size(); ++t)
    for (std::size_t f = 0; f < found.size(); ++f) {
      TrueObject& object = score.objects[t];
      if (found[f].class_id != object.class_id) continue;
      const double away_m = (found[f].center_m - object.center_m).norm();
      if (object.away_m < 0 || away_m < object.away_m) object.away_m = away_m;
      if (away_m <= reach_m) pairs.emplace_back(away_m, t, f);
    }
  std::ranges::sort(pairs);
  std::vector<bool> used(found.size(), false);
  for (const auto& [away_m, t, f] : pairs)
    if (!score.objects[t].found && !used[f]) {
      score.objects[t].found = true;
      used[f] = true;
    }
  // Small objects are left out only after matching, since voxels can enlarge an object beyond
  // least_m.
  std::erase_if(score.objects, [&](const TrueObject& o) { return o.size_m.maxCoeff() < least_m; });
  for (const TrueObject& object : score.objects) score.recall.add(object.found);
  for (std::size_t f = 0; f < found.size(); ++f)
    if ((found[f].max_m - found[f].min_m).maxCoeff() >= least_m) score.precision.add(used[f]);
  return score;
}

}  // namespace mh
