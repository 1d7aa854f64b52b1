// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include <Eigen/Core>

#include "slam/core/grid2d.hpp"

namespace mh {

/// A floor from above, true or as a map shows it: each cell's distance to the nearest place that is
/// not free. Column grows with world x, row with world y.
struct FloorGrid {
  double resolution_m = 0.04;
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< center of cell (0, 0)
  /// Lower bound on the distance from the cell's center to the nearest obstacle or the edge of the
  /// floor, m; 0 at obstacles and where there is no floor.
  Grid2d<float> clearance_m;
  Grid2d<std::uint16_t> occupant;  ///< instance that occupies the cell, if known; 0 = nothing

  using Cell = std::pair<int, int>;  ///< column, row
  /// The cell that contains a place; nullopt outside the grid.
  std::optional<Cell> cell_of(const Eigen::Vector2d& place_m) const;
  Eigen::Vector2d center_of(const Cell& cell) const {
    return origin_m + resolution_m * Eigen::Vector2d(cell.first, cell.second);
  }
  /// Clearance of the cell that contains a place; 0 outside the grid.
  double clearance_at(const Eigen::Vector2d& place_m) const;
  /// Whether the straight line keeps `clearance_m` from everything.
  bool clear_line(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                  double clearance_m) const;
};

/// Marks the largest connected region of cells with at least that clearance: 1 inside, 0 outside.
/// All 0 if no cell has it.
Grid2d<std::uint8_t> largest_region(const FloorGrid& grid, double clearance_m);

/// Distance (cells) from each cell's center to that of the nearest marked one; infinite if there is
/// none. Exact: Felzenszwalb and Huttenlocher, "Distance transforms of sampled functions", 2012.
Grid2d<float> distances(const Grid2d<std::uint8_t>& marked);

/// Clearances of cells. Since a cell is blocked if anything touches it, an obstacle may be up to
/// half a cell's diagonal closer than the center of its cell; the clearances are reduced by that.
Grid2d<float> clearances_m(const Grid2d<std::uint8_t>& blocked, double resolution_m);

/// The grid of a map that shows where obstacles are, but not which objects they are.
/// @param origin_m  center of cell (0, 0)
FloorGrid floor_grid_of(const Grid2d<std::uint8_t>& blocked, double resolution_m,
                        const Eigen::Vector2d& origin_m);

}  // namespace mh
