// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/obstacles.hpp"

#include <span>

#include "scenes/band.hpp"
#include "sim/physics/outline.hpp"

namespace mh {

std::unique_ptr<Obstacles> seen_obstacles(const Scene& scene, float top_m) {
  auto result = std::make_unique<Obstacles>();
  const auto point = [](const Eigen::Vector3f& p) { return btVector3(p.x(), p.y(), p.z()); };
  for_each_face_in_band(scene, static_cast<float>(scene.floor.rough_m), top_m,
                        [&](std::size_t face, std::span<const Eigen::Vector3f> polygon) {
                          for (std::size_t i = 2; i < polygon.size(); ++i) {
                            result->mesh.addTriangle(point(polygon[0]), point(polygon[i - 1]),
                                                     point(polygon[i]));
                            result->instance_of.push_back(scene.instance_of[face]);
                          }
                        });
  result->make_shape();
  return result;
}

std::unique_ptr<Obstacles> felt_obstacles(const Scene& scene, float top_m, float middle_m) {
  auto result = std::make_unique<Obstacles>();
  const float low = middle_m - kOverhang_m, high = middle_m + kOverhang_m;
  for (const OutlineEdge& edge :
       floor_outline(scene, static_cast<float>(scene.floor.rough_m), top_m)) {
    const btVector3 a(edge.a_m.x(), edge.a_m.y(), low), b(edge.b_m.x(), edge.b_m.y(), low),
        a_high(edge.a_m.x(), edge.a_m.y(), high), b_high(edge.b_m.x(), edge.b_m.y(), high);
    result->mesh.addTriangle(a, b, b_high);
    result->mesh.addTriangle(a, b_high, a_high);
    result->instance_of.insert(result->instance_of.end(), 2, edge.instance);
  }
  result->make_shape();
  return result;
}

}  // namespace mh
