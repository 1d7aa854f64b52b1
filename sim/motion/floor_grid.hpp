// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "robots/navigation/grid.hpp"
#include "scenes/scene.hpp"

namespace mh {

struct FloorGridConfig {
  double resolution_m = 0.04;  ///< side of a cell, 0.005 to 1
  // Faces entirely above or below are not obstacles.
  /// Default: above the floor's roughness (rugs, thresholds), as in PlanarWorld.
  std::optional<double> bottom_m = {};
  double top_m = 1.21;  ///< the robot's height
};

/// Marks every face between the floor and the robot's head as an obstacle (each cell that it
/// touches) and every face that is level and near z = 0 as floor; gaps of up to 0.2 m in the floor,
/// as in scanned meshes, are closed. If the scene has rooms, nothing beyond their bounds is floor.
/// @pre the scene's floor is z = 0 (LevelScene)
/// @throws InputError if there is no floor, or it is more than 4096 cells long or wide.
FloorGrid make_floor_grid(const Scene& scene, const FloorGridConfig& config = {});

/// Returns " against NAME", naming the object nearest to a place within reach, for messages; "" if
/// there is none.
std::string occupant_near(const FloorGrid& grid, const Scene& scene, const Eigen::Vector2d& place_m,
                          double reach_m);

}  // namespace mh
