// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <btBulletCollisionCommon.h>

#include "scenes/scene.hpp"

namespace mh {

/// What is met sideways reaches past the middle of the robot by this much, up and down: the
/// shortest way out of any overlap is sideways, the only way a planar body can go.
inline constexpr float kOverhang_m = 1.0F;

/// Triangles, the instance that each belongs to, and the shape made of them.
struct Obstacles {
  btTriangleMesh mesh;
  std::vector<InstanceId> instance_of;
  std::unique_ptr<btBvhTriangleMeshShape> shape;  // none if there are no triangles

  void make_shape() {
    if (!instance_of.empty()) shape = std::make_unique<btBvhTriangleMeshShape>(&mesh, true);
  }
};

/// Triangles of the scene, cut to the band of heights in which they are obstacles: what rays meet.
std::unique_ptr<Obstacles> seen_obstacles(const Scene& scene, float top_m);

/// Upright walls along the outline of the same, two triangles for each edge: what the base runs
/// into. An upright cylinder among triangles is a disc among their outlines.
std::unique_ptr<Obstacles> felt_obstacles(const Scene& scene, float top_m, float middle_m);

}  // namespace mh
