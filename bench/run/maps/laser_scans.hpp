// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/occupancy/obstacle_grid.hpp"

namespace mh {

/// The lasers of a robot on its path through a scene: a second source for a map, in addition to
/// depth.
class SceneLasers {
 public:
  /// @throws InputError if the robot has no lasers.
  SceneLasers(const Scene& scene, Robot robot);
  ~SceneLasers();
  SceneLasers(SceneLasers&&) noexcept;

  /// The lasers' readings at each estimated pose whose true pose is known: read at the true pose,
  /// placed at the estimated one.
  /// @param map_from_camera    ordered by stamp
  /// @param world_from_camera  the true poses of the robot's camera, ordered by stamp
  ScanGrid scans(const Trajectory& map_from_camera, const Trajectory& world_from_camera,
                 double resolution_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mh
