// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "scenes/scene.hpp"

namespace mh {

/// An edge of the obstacles' outline on the floor.
struct OutlineEdge {
  Eigen::Vector2f a_m, b_m;
  InstanceId instance = 0;
};

/// Returns the outline, seen from above, of everything between two heights: what an upright
/// cylinder that extends past both can collide with. Edges with a face on both sides are left out,
/// since anything that comes from outside hits another edge first.
/// @returns each edge once, sorted by its ends; an edge shared by several instances gets the
/// instance of the first face
std::vector<OutlineEdge> floor_outline(const Scene& scene, float bottom_m, float top_m);

}  // namespace mh
