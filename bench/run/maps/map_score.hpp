// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/run/maps/true_space.hpp"
#include "scenes/scene.hpp"
#include "slam/occupancy/objects.hpp"
#include "slam/occupancy/obstacle_grid.hpp"
#include "slam/occupancy/voxel_map.hpp"

namespace mh {

/// A share, given by counts.
struct Share {
  std::size_t good = 0, all = 0;
  void add(bool is_good) { good += is_good ? 1 : 0, ++all; }
  double value() const {
    return all == 0 ? 0.0 : static_cast<double>(good) / static_cast<double>(all);
  }
};

/// A voxel map compared with the exact mesh. "Seen" means hit or crossed by exact rays from the
/// true poses of the same keyframes, within the depth model's range, through pixels in which the
/// sensor had a return.
struct VoxelScore {
  Share occupied_precision;  ///< share of the occupied voxels within one cell of a true surface
  Share occupied_recall;  ///< share of the seen true surfaces within one cell of an occupied voxel
  Share free_precision;  ///< share of the free voxels that are in open space, touched by no surface
  Share free_within_one;  ///< share of the free voxels within one cell of open space
  Share free_recall;      ///< share of the open space seen as free that is free in the map
};

/// @param exact  a map of what could be seen: the same keyframes with exact depth at their true
/// poses
VoxelScore score_voxels(const VoxelMap& map, const VoxelMap& exact, const TrueSpace& truth);

/// A grid compared with the true floor plan, over the cells of the plan.
struct GridScore {
  Share iou;       ///< of free cells: free in both / free in either
  Share iou_seen;  ///< the same, over cells that are known in the grid
};
/// @pre equal resolutions; origins at multiples of the resolution
GridScore score_grid(const OccupancyGrid& grid, const OccupancyGrid& plan);

/// A true object, and how far away the nearest found object of its class is.
struct TrueObject {
  std::string name;
  ClassId class_id = kVoid;
  Eigen::Vector3d center_m, size_m;
  bool found = false;
  double away_m = -1;  ///< distance to the nearest found object of its class; -1 if there is none
};

struct ObjectScore {
  /// Share of the true objects at least least_m long that have a found object of their class within
  /// reach_m.
  Share recall;
  /// Share of the found objects at least least_m long that have a true object of their class, of
  /// any size, within reach_m.
  Share precision;
  std::vector<TrueObject> objects;
};

/// @param least_m  minimum length of an object's longest side
/// @param reach_m  maximum distance between centers
ObjectScore score_objects(const std::vector<MapObject>& found, const Scene& scene,
                          double least_m = 0.4, double reach_m = 0.25);

}  // namespace mh
