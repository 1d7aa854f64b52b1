// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "slam/core/se3.hpp"
#include "slam/occupancy/occupancy_grid.hpp"
#include "slam/occupancy/voxel_map.hpp"

namespace mh {

/// Which part of a map obstructs a robot. Heights above the map's z = 0.
struct ObstacleGridConfig {
  double floor_z_m = 0.0;
  /// Anything lower than this above the floor counts as floor. 0.10 m is two voxels, and more than
  /// the depth noise at 4 m. If a voxel is larger than this, the limit is half of this plus half a
  /// voxel.
  double ground_m = 0.10;
  double robot_height_m = 1.21;  ///< what is higher does not touch the robot
  /// A cell is free only if its free voxels begin below this height above the floor: otherwise,
  /// something low may be hidden.
  double seen_below_m = 0.50;

  /// Height (m) that the center of a voxel of that size must reach to be above the ground.
  double lowest_m(double resolution_m) const {
    // A large voxel that begins lower than half of ground_m contains the floor.
    return floor_z_m + std::max(ground_m, 0.5 * (ground_m + resolution_m));
  }
};

/// Projects the part of a map between the ground and the robot's head to cells of the map's
/// resolution. A cell is occupied if any of its voxels in this part is, so a table top is an
/// obstacle and a lintel is not. It is free if none is occupied, the lower part was seen to be
/// free, and the free voxels have no gap (the gap may be a table top that gave no return).
/// Otherwise, it is unknown. The grid is empty if nothing was seen in this part.
/// @throws InputError if the heights leave nothing between them.
OccupancyGrid obstacle_grid(const VoxelMap& map, const ObstacleGridConfig& config = {});

/// 1 in each cell that is not known to be free: where paths must not lead.
Grid2d<std::uint8_t> blocked_cells(const OccupancyGrid& grid);

/// One revolution of a planar laser. A range that is 0, not finite, or outside [min, max] is
/// ignored.
struct RangeScan {
  double first_angle_rad = 0;      ///< of ranges_m[0], about z of the sensor, 0 = its x axis
  double angle_increment_rad = 0;  ///< between readings
  double min_range_m = 0.0, max_range_m = 3.0;
  std::vector<float> ranges_m;
};

/// What lasers saw on a floor, as counts per cell: a source for a grid in addition to depth. Counts
/// depend on the set of scans alone, not on their order.
class ScanGrid {
 public:
  explicit ScanGrid(double resolution_m = 0.05) : resolution_m_(resolution_m) {}
  /// Adds a scan taken at a pose. @param map_from_sensor  only x, y and heading are used
  void add_scan(const SE3& map_from_sensor, const RangeScan& scan);
  /// Adds the scans to a grid, which grows as needed: cells become occupied where the log-odds of
  /// hits and misses (VoxelMap's increments) are not negative, and free where rays passed through
  /// and the grid is unknown. Occupied cells of the grid remain occupied, since the laser's plane
  /// may pass below an obstacle such as a table top.
  /// @pre the grid's origin is a multiple of its resolution, as in obstacle_grid()
  /// @throws InputError if the resolutions differ.
  void add_to(OccupancyGrid& grid) const;

 private:
  struct Counts {
    int hits = 0, misses = 0;
  };
  double resolution_m_;
  std::map<std::pair<int, int>, Counts> cells_;  // by (row, column)
};

}  // namespace mh
