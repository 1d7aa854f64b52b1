// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "slam/core/labels.hpp"
#include "slam/occupancy/occupancy_grid.hpp"
#include "slam/occupancy/voxel_map.hpp"

namespace mh {

/// A point of a map with its class, in the map frame.
struct MapPoint {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  ClassId label = kVoid;
};

/// The centers of the occupied voxels that have a class.
std::vector<MapPoint> points_of(const VoxelMap& map);

/// Draws a grid as a floor seen at a slant, and points above it in the colors of their classes, as
/// in the paper's Figure 5a. Points above `ceiling_m` and points without a class are left out.
cv::Mat draw_classes_over(const OccupancyGrid& grid, const std::vector<MapPoint>& points,
                          double ceiling_m = 1.9);

/// Draws a grid against the true floor plan: correct free space and obstacles, missed and invented
/// obstacles, and unseen floor.
cv::Mat draw_against_truth(const OccupancyGrid& grid, const OccupancyGrid& plan);

}  // namespace mh
