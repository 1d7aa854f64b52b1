// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "slam/core/ids.hpp"

namespace mh {

/// Keyframes indexed by camera position, in cubes of kCell_m: finds those near a position without
/// visiting the others.
class PositionIndex {
 public:
  void add(KeyframeId keyframe, const Eigen::Vector3d& position_in_world);
  /// @param position_in_world  the position with which it was added.
  void remove(KeyframeId keyframe, const Eigen::Vector3d& position_in_world);
  /// All keyframes in cubes that a ball intersects (a superset of those inside it), by id.
  std::vector<KeyframeId> near(const Eigen::Vector3d& center_in_world, double radius_m) const;

 private:
  static constexpr double kCell_m = 2.5;
  using Cell = std::array<int, 3>;
  static Cell cell_of(const Eigen::Vector3d& position_in_world);

  std::map<Cell, std::vector<KeyframeId>> cells_;  // no cell is empty
};

}  // namespace mh
