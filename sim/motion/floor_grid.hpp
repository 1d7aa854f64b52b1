// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "robots/navigation/grid.hpp"
#include "scenes/scene.hpp"

namespace mh {

struct FloorGridConfig {
  double resolution_m = 0.04;  ///< side of a cell, 0.005 to 1
  // Faces entirely below bottom_m or above top_m are not obstacles.
  /// Default: above the floor's roughness (rugs, thresholds), as in PlanarWorld.
  std::optional<double> bottom_m = {};
  double top_m = 1.21;  ///< the robot's height
};

/// Marks the cells that a face touches: as an obstacle if the face is between the floor and the
/// robot's head, as floor if it is level and near z = 0. Gaps of up to 0.2 m in the floor, as in
/// scanned meshes, are closed. If the scene has rooms, nothing beyond their bounds is floor.
/// @pre the scene's floor is z = 0 (LevelScene)
/// @throws InputError if there is no floor, or it is more than 4096 cells long or wide.
FloorGrid make_floor_grid(const Scene& scene, const FloorGridConfig& config = {});

/// Returns " against NAME" for messages, with the object nearest to a place; "" if there is none
/// within `reach_m`.
std::string occupant_near(const FloorGrid& grid, const Scene& scene, const Eigen::Vector2d& place_m,
                          double reach_m);

}  // namespace mh
