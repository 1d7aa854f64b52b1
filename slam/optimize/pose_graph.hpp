// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slam/core/se3.hpp"

namespace mh {

/// A measured relative pose.
struct PoseGraphEdge {
  std::uint32_t a = 0, b = 0;  ///< indices of poses
  SE3 a_from_b;
  double weight = 1;  ///< of its squared error, relative to the other edges: how strongly it
                      ///< constrains the two poses
};

struct PoseGraphConfig {
  double sigma_m = 0.01;     ///< of the translation of an edge with weight 1
  double sigma_rad = 0.002;  ///< and of its rotation; only the ratio of the two matters
  int max_iterations = 20;
};

/// Distributes inconsistencies over the edges: argmin over poses of the weighted sum of squared
/// differences between a_from_world * world_from_b and a_from_b (Grisetti et al., "A tutorial on
/// graph-based SLAM", 2010). The first pose is fixed. Solved by Ceres on one thread.
/// @returns camera_from_world of every pose.
std::vector<SE3> optimize_pose_graph(const std::vector<SE3>& camera_from_world,
                                     const std::vector<PoseGraphEdge>& edges,
                                     const PoseGraphConfig& config = {});

}  // namespace mh
