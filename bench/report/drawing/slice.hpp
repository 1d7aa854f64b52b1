// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "scenes/scene.hpp"

namespace mh {

/// A line segment of a horizontal cut through a scene.
struct SliceSegment {
  Eigen::Vector2d from_m, to_m;
  ClassId class_id = kVoid;
};

/// Intersects the scene's triangles with the plane z = height, in face order. Vertices in the plane
/// are treated as above it, so that every cut triangle gives one segment.
std::vector<SliceSegment> slice(const Scene& scene, double height_m);

}  // namespace mh
