// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "scenes/scene.hpp"
#include "slam/occupancy/occupancy_grid.hpp"

namespace mh {

/// The exact mesh of a scene as voxels: what a map of it should contain.
class TrueSpace {
 public:
  enum class State : std::uint8_t {
    kClosed,   ///< inside of solids, behind walls, or outside of the scene
    kOpen,     ///< space that is connected to a seed
    kSurface,  ///< a face touches the voxel; panes of glass do not count: depth cameras do not see
               ///< them
  };

  /// @param seeds  places in open space, such as camera positions
  TrueSpace(const Scene& scene, double resolution_m, std::span<const Eigen::Vector3d> seeds);

  /// The state of the voxel with an index, as in VoxelMap; kClosed outside of the scene.
  State at(const Eigen::Vector3i& voxel) const;
  /// Whether this voxel, or one at most one cell away along each axis, has that state.
  bool is_near(const Eigen::Vector3i& voxel, State state) const;
  /// The true floor plan between two heights: occupied where a surface is, free where a cell is
  /// connected to a seed without crossing an occupied cell, else unknown. Cut to the box of the
  /// rooms, if the scene has any: what is seen through a window is not part of the plan.
  OccupancyGrid floor_plan(double low_m, double high_m,
                           std::span<const Eigen::Vector3d> seeds) const;

 private:
  State* cell(const Eigen::Vector3i& voxel);
  void mark(const std::array<Eigen::Vector3d, 3>& corners_in_voxels);
  void open_from(const Eigen::Vector3i& seed);

  double resolution_m_;
  Eigen::Vector3i low_, size_;
  Eigen::Vector2i plan_low_, plan_high_;  ///< first and last cell of the rooms, the last excluded
  std::vector<State> cells_;
};

}  // namespace mh
