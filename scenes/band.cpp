// SPDX-License-Identifier: Apache-2.0
#include "scenes/band.hpp"

#include <algorithm>
#include <vector>

#include "scenes/floor.hpp"

namespace mh {
namespace {

using Polygon = std::vector<Eigen::Vector3f>;

/// The part of a convex polygon where sign * (z - height) >= 0 (Sutherland and Hodgman, 1974).
Polygon clip(const Polygon& polygon, float height_m, float sign) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3f& a = polygon[i];
    const Eigen::Vector3f& b = polygon[(i + 1) % polygon.size()];
    const float above_a = sign * (a.z() - height_m), above_b = sign * (b.z() - height_m);
    if (above_a >= 0) kept.push_back(a);
    if ((above_a > 0 && above_b < 0) || (above_a < 0 && above_b > 0))
      kept.push_back(a + (b - a) * (above_a / (above_a - above_b)));
  }
  return kept;
}

}  // namespace

void for_each_face_in_band(
    const Scene& scene, float bottom_m, float top_m,
    const std::function<void(std::size_t, std::span<const Eigen::Vector3f>)>& visit) {
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    Polygon polygon;
    for (const std::uint32_t v : scene.triangles[face]) polygon.push_back(scene.positions_m[v]);
    const auto [low, high] = std::minmax({polygon[0].z(), polygon[1].z(), polygon[2].z()});
    if (high < bottom_m || low > top_m) continue;
    if (static_cast<double>(high) <= kHighestFloor_m &&
        static_cast<double>(low) >= -kDeepestFloor_m && is_walked_on(scene.class_of[face]))
      continue;
    if (low < bottom_m) polygon = clip(polygon, bottom_m, 1.0F);
    if (high > top_m) polygon = clip(polygon, top_m, -1.0F);
    if (polygon.size() >= 3) visit(face, polygon);
  }
}

}  // namespace mh
