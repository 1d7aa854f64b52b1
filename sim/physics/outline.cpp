// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/outline.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>

#include "scenes/band.hpp"

namespace mh {
namespace {

using Eigen::Vector2f;

/// An edge of one face, from the lesser end to the greater.
struct FaceEdge {
  std::array<float, 4> ends;  // ax, ay, bx, by
  std::uint32_t face = 0;
  bool left = false, right = false;  // where the face lies, seen from above; neither: upright
};

/// Twice the signed area seen from above, m2.
float doubled_area_m2(std::span<const Eigen::Vector3f> polygon) {
  float sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Vector2f u = (polygon[i - 1] - polygon[0]).head<2>(),
                   v = (polygon[i] - polygon[0]).head<2>();
    sum += u.x() * v.y() - u.y() * v.x();
  }
  return sum;
}

}  // namespace

std::vector<OutlineEdge> floor_outline(const Scene& scene, float bottom_m, float top_m) {
  constexpr float kUpright_m2 = 1e-9F;
  std::vector<FaceEdge> edges;
  for_each_face_in_band(scene, bottom_m, top_m,
                        [&](std::size_t face, std::span<const Eigen::Vector3f> polygon) {
                          const float area_m2 = doubled_area_m2(polygon);
                          for (std::size_t i = 0; i < polygon.size(); ++i) {
                            std::pair from(polygon[i].x(), polygon[i].y());
                            std::pair to(polygon[(i + 1) % polygon.size()].x(),
                                         polygon[(i + 1) % polygon.size()].y());
                            if (from == to) continue;  // upright
                            bool left = area_m2 > kUpright_m2, right = area_m2 < -kUpright_m2;
                            if (to < from) {
                              std::swap(from, to);
                              std::swap(left, right);
                            }
                            edges.push_back({.ends = {from.first, from.second, to.first, to.second},
                                             .face = static_cast<std::uint32_t>(face),
                                             .left = left,
                                             .right = right});
                          }
                        });
  std::sort(edges.begin(), edges.end(), [](const FaceEdge& a, const FaceEdge& b) {
    return std::tie(a.ends, a.face) < std::tie(b.ends, b.face);
  });
  std::vector<OutlineEdge> outline;
  for (std::size_t i = 0; i < edges.size();) {
    const FaceEdge& first = edges[i];
    bool left = false, right = false;
    for (; i < edges.size() && edges[i].ends == first.ends; ++i) {
      left |= edges[i].left;
      right |= edges[i].right;
    }
    if (left && right) continue;
    outline.push_back({{first.ends[0], first.ends[1]},
                       {first.ends[2], first.ends[3]},
                       scene.instance_of[first.face]});
  }
  return outline;
}

}  // namespace mh
