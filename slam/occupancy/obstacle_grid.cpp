// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/obstacle_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

/// Grows a grid so that it contains cells [low, high) counted from its world's origin.
void grow_to(OccupancyGrid& grid, const Vector2i& low, const Vector2i& high) {
  const Vector2i old_low = (grid.origin_m / grid.resolution_m).array().round().cast<int>().matrix();
  const Vector2i old_high = old_low + Vector2i(grid.cells.width(), grid.cells.height());
  const Vector2i new_low = grid.cells.empty() ? low : old_low.cwiseMin(low).eval();
  const Vector2i new_high = grid.cells.empty() ? high : old_high.cwiseMax(high).eval();
  if (!grid.cells.empty() && new_low == old_low && new_high == old_high) return;
  const Vector2i size = new_high - new_low;
  Grid2d<std::int8_t> cells(size.x(), size.y(), kUnknownCell);
  for (int y = 0; y < grid.cells.height(); ++y)
    for (int x = 0; x < grid.cells.width(); ++x)
      cells(x + old_low.x() - new_low.x(), y + old_low.y() - new_low.y()) = grid.cells(x, y);
  grid.cells = std::move(cells);
  grid.origin_m = grid.resolution_m * new_low.cast<double>();
}

/// Calls visit(cell) for the cells on the line from one place (in cells) to another, in order,
/// without the last cell: Amanatides and Woo, "A fast voxel traversal algorithm", 1987.
template <class Visit>
void for_each_cell_before(const Vector2d& from, const Vector2d& to, Visit visit) {
  Vector2i cell = from.array().floor().cast<int>();
  const Vector2i last = to.array().floor().cast<int>();
  const Vector2d way = to - from;
  Vector2d next, per_cell;  // shares of the line: to the next border, between borders
  Vector2i step;
  for (int axis = 0; axis < 2; ++axis) {
    step[axis] = way[axis] > 0 ? 1 : -1;
    const double border = cell[axis] + (way[axis] > 0 ? 1.0 : 0.0);
    constexpr double kNever = std::numeric_limits<double>::infinity();
    next[axis] = way[axis] == 0 ? kNever : (border - from[axis]) / way[axis];
    per_cell[axis] = way[axis] == 0 ? kNever : std::abs(1 / way[axis]);
  }
  for (int left = (last - cell).cwiseAbs().sum(); left > 0; --left) {
    visit(cell);
    const int axis = next.x() <= next.y() ? 0 : 1;
    cell[axis] += step[axis];
    next[axis] += per_cell[axis];
  }
}

}  // namespace

OccupancyGrid obstacle_grid(const VoxelMap& map, const ObstacleGridConfig& config) {
  const double r = map.resolution_m();
  const double low_m = config.lowest_m(r), high_m = config.floor_z_m + config.robot_height_m;
  if (!(low_m < high_m))
    throw InputError(
        fmt::format("grid: the heights from {} m to {} m are an empty range", low_m, high_m));
  constexpr int kFar = std::numeric_limits<int>::max();
  /// What is known about the voxels above a cell.
  struct Column {
    bool occupied = false;
    int lowest = kFar, highest = -kFar, free = 0;  ///< of its free voxels
  };
  Vector2i low(kFar, kFar), high(-kFar, -kFar);
  std::map<std::pair<int, int>, Column> columns;  // by (row, column)
  map.for_each([&](const Voxel& voxel) {
    const double z_m = r * (voxel.index.z() + 0.5);
    if (z_m < low_m || z_m > high_m) return;
    const Vector2i cell = voxel.index.head<2>();
    low = low.cwiseMin(cell);
    high = high.cwiseMax(cell);
    Column& column = columns[{cell.y(), cell.x()}];
    column.occupied = column.occupied || voxel.occupied;
    if (voxel.occupied) return;
    column.lowest = std::min(column.lowest, voxel.index.z());
    column.highest = std::max(column.highest, voxel.index.z());
    ++column.free;
  });
  OccupancyGrid grid;
  grid.resolution_m = r;
  if (columns.empty()) return grid;
  grow_to(grid, low, high + Vector2i::Ones());
  const double seen_m = std::max(config.floor_z_m + config.seen_below_m, low_m + r);
  for (const auto& [cell, column] : columns) {
    const bool is_free = column.free > 0 && r * (column.lowest + 0.5) < seen_m &&
                         column.highest - column.lowest + 1 == column.free;
    grid.cells(cell.second - low.x(), cell.first - low.y()) = column.occupied ? kOccupiedCell
                                                              : is_free       ? kFreeCell
                                                                              : kUnknownCell;
  }
  return grid;
}

Grid2d<std::uint8_t> blocked_cells(const OccupancyGrid& grid) {
  Grid2d<std::uint8_t> blocked(grid.cells.width(), grid.cells.height());
  std::ranges::transform(grid.cells, blocked.begin(), [](std::int8_t cell) {
    return static_cast<std::uint8_t>(cell != kFreeCell);
  });
  return blocked;
}

void ScanGrid::add_scan(const SE3& map_from_sensor, const RangeScan& scan) {
  const Vector2d eye = map_from_sensor.translation().head<2>() / resolution_m_;
  const Vector2d ahead = map_from_sensor.rotation().col(0).head<2>();
  const double heading = std::atan2(ahead.y(), ahead.x());
  std::set<std::pair<int, int>> hits, misses;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const auto range_m = static_cast<double>(scan.ranges_m[i]);
    if (!(range_m > 0) || range_m < scan.min_range_m || !(range_m <= scan.max_range_m)) continue;
    const double angle =
        heading + scan.first_angle_rad + static_cast<double>(i) * scan.angle_increment_rad;
    const Vector2d end = eye + range_m / resolution_m_ * Vector2d(std::cos(angle), std::sin(angle));
    for_each_cell_before(eye, end,
                         [&](const Vector2i& cell) { misses.emplace(cell.y(), cell.x()); });
    hits.emplace(static_cast<int>(std::floor(end.y())), static_cast<int>(std::floor(end.x())));
  }
  for (const auto& cell : hits) ++cells_[cell].hits;
  for (const auto& cell : misses)
    if (!hits.contains(cell)) ++cells_[cell].misses;
}

void ScanGrid::add_to(OccupancyGrid& grid) const {
  if (grid.resolution_m != resolution_m_)
    throw InputError(fmt::format("grid: cells of {} m and scans in cells of {} m",
                                 grid.resolution_m, resolution_m_));
  if (cells_.empty()) return;
  Vector2i low(cells_.begin()->first.second, cells_.begin()->first.first), high = low;
  for (const auto& [cell, counts] : cells_) {
    low = low.cwiseMin(Vector2i(cell.second, cell.first));
    high = high.cwiseMax(Vector2i(cell.second, cell.first));
  }
  grow_to(grid, low, high + Vector2i::Ones());
  const Vector2i corner = (grid.origin_m / resolution_m_).array().round().cast<int>().matrix();
  for (const auto& [cell, counts] : cells_) {
    std::int8_t& state = grid.cells(cell.second - corner.x(), cell.first - corner.y());
    const float log_odds = kHitLogOdds * static_cast<float>(counts.hits) +
                           kMissLogOdds * static_cast<float>(counts.misses);
    if (log_odds >= 0)
      state = kOccupiedCell;
    else if (state == kUnknownCell)
      state = kFreeCell;
  }
}

}  // namespace mh
