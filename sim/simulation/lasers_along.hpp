// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "robots/model/robot.hpp"
#include "scenes/floor.hpp"
#include "sim/motion/motion.hpp"
#include "sim/physics/planar_world.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// What a robot's lasers measure along a path, computed on demand: at(i) is a pure function of i.
/// Safe to use from several threads.
class LasersAlong {
 public:
  /// @param seed    seed of the noise
  /// @param others  moving obstacles
  /// @throws InputError if the robot has no lasers
  LasersAlong(std::shared_ptr<const Scene> scene, const Robot& robot, const DrivenPath& path,
              std::uint64_t seed, const std::vector<MovingObstacle>& others = {});
  /// The scans at the i-th pose of the path, by laser.
  std::vector<LaserScan> at(std::size_t i) const;

 private:
  std::shared_ptr<const Scene> scene_;
  LevelScene level_;
  Equipment equipment_;
  Trajectory base_, camera_;
  std::uint64_t seed_;
  mutable std::mutex one_at_a_time_;  // obstacles are moved for each scan
  mutable PlanarWorld world_;
};

}  // namespace mh
