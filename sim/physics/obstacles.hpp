// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <btBulletCollisionCommon.h>

#include "scenes/scene.hpp"

namespace mh {

/// Walls extend this far above and below the robot's middle, so that the shortest way out of any
/// overlap is sideways, the only direction in which a planar body can move.
inline constexpr float kOverhang_m = 1.0F;

/// Triangles, the instance of each, and the shape built from them.
struct Obstacles {
  btTriangleMesh mesh;
  std::vector<InstanceId> instance_of;
  std::unique_ptr<btBvhTriangleMeshShape> shape;  // null if there are no triangles

  void make_shape() {
    if (!instance_of.empty()) shape = std::make_unique<btBvhTriangleMeshShape>(&mesh, true);
  }
};

/// Returns the scene's triangles, clipped to the band of heights in which they are obstacles: what
/// rays hit.
std::unique_ptr<Obstacles> seen_obstacles(const Scene& scene, float top_m);

/// Returns vertical walls along the outline of the same triangles, two triangles per edge: what the
/// base collides with. An upright cylinder among triangles is equivalent to a disc among their
/// outlines.
std::unique_ptr<Obstacles> felt_obstacles(const Scene& scene, float top_m, float middle_m);

}  // namespace mh
