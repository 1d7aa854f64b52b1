// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "scenes/scene.hpp"

namespace mh {

/// A piece of the outline that obstacles have on the floor.
struct OutlineEdge {
  Eigen::Vector2f a_m, b_m;
  InstanceId instance = 0;
};

/// The outline, seen from above, of everything between two heights: what an upright cylinder that
/// reaches past both can run into. Of the faces' edges those are left out that have a face on both
/// sides, since who comes from outside meets another first.
/// @returns each edge once, in the order of its ends; for edges shared by several instances, the
/// one of the first face
std::vector<OutlineEdge> floor_outline(const Scene& scene, float bottom_m, float top_m);

}  // namespace mh
