// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "scenes/scene.hpp"
#include "slam/core/grid2d.hpp"

namespace mh {

struct FloorGridConfig {
  double resolution_m = 0.04;  ///< side of a cell, 0.005 to 1
  // Faces entirely above or below are not obstacles.
  /// Default: above the floor's roughness (rugs, thresholds), as in PlanarWorld.
  std::optional<double> bottom_m = {};
  double top_m = 1.21;  ///< the robot's height
};

/// The floor of a scene from above: each cell's distance to the nearest place where nothing can
/// stand. Column grows with world x, row with world y.
struct FloorGrid {
  double resolution_m = 0.04;
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< center of cell (0, 0)
  /// Lower bound on the distance from the cell's center to the nearest obstacle or the edge of the
  /// floor, m; 0 where something stands or there is no floor.
  Grid2d<float> clearance_m;
  Grid2d<InstanceId> occupant;  ///< what stands in the cell; 0 = nothing

  using Cell = std::pair<int, int>;  ///< column, row
  /// The cell that contains a place; nullopt outside the grid.
  std::optional<Cell> cell_of(const Eigen::Vector2d& place_m) const;
  Eigen::Vector2d center_of(const Cell& cell) const {
    return origin_m + resolution_m * Eigen::Vector2d(cell.first, cell.second);
  }
  /// 0 outside.
  double clearance_at(const Eigen::Vector2d& place_m) const;
  /// Whether the straight line keeps that distance from everything.
  bool clear_line(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                  double clearance_m) const;
};

/// Marks every face between the floor and the robot's head as an obstacle (each cell that it
/// touches) and every face that is level and near z = 0 as floor; gaps of up to 0.2 m in the floor,
/// as in scanned meshes, are closed. If the scene has rooms, nothing beyond their bounds is floor.
/// @pre the scene's floor is z = 0 (LevelScene)
/// @throws InputError if there is no floor, or it is larger than 4096 cells either way.
FloorGrid make_floor_grid(const Scene& scene, const FloorGridConfig& config = {});

/// Marks the largest connected region of cells with at least that clearance: 1 inside, 0 outside.
/// All 0 if no cell has it.
Grid2d<std::uint8_t> largest_region(const FloorGrid& grid, double clearance_m);

/// Returns " against NAME" or "": the object nearest to a place within reach, for messages.
std::string occupant_near(const FloorGrid& grid, const Scene& scene, const Eigen::Vector2d& place_m,
                          double reach_m);

}  // namespace mh
