// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "sim/physics/outline.hpp"

namespace mh {

/// The external-collision reflex: how fast the base may keep moving in a direction.
/// @pre the robot has this reflex
class Reflex {
 public:
  Reflex(const Scene& scene, const Robot& robot);

  /// @param direction  direction of travel, world, unit
  /// @param others     moving obstacles: place and radius, m
  double allowed_m_per_s(const Eigen::Vector2d& place_m, const Eigen::Vector2d& direction,
                         const std::vector<std::pair<Eigen::Vector2d, double>>& others) const;

 private:
  double soft_m() const;
  double way_to_disc_m(const Eigen::Vector2d& middle, double size_m) const;
  double way_to_edge_m(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;

  std::vector<OutlineEdge> outline_;
  double radius_m_;
  CollisionReflex zone_;
  double brake_m_per_s2_;
  double reach_m_;
};

}  // namespace mh
