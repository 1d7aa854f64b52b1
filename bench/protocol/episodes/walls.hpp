// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "scenes/scene.hpp"

namespace mh {

/// The true walls of a scene, seen from above.
class TrueWalls {
 public:
  /// Takes the part of each wall between the floor and the robot's height.
  /// @pre the scene's floor is z = 0 (LevelScene)
  TrueWalls(const Scene& scene, double robot_height_m);

  /// Whether a wall crosses the straight line between two places. Walls that cross only its last 2
  /// cm do not count: the goal may stand against that wall.
  bool between(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const;

 private:
  struct Outline {
    std::vector<Eigen::Vector2d> corners_m;  ///< of a convex polygon; on one line if vertical
    Eigen::AlignedBox2d bounds_m;
  };
  std::vector<Outline> outlines_;
};

}  // namespace mh
