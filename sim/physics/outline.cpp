// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "scenes/band.hpp"

namespace mh {
namespace {

using Eigen::Vector2f;

/// An edge of one face, from its lexicographically lesser end to the greater.
struct FaceEdge {
  std::array<float, 4> ends;  // ax, ay, bx, by
  std::uint32_t face = 0;
  bool left = false, right = false;  // side of the face, seen from above; neither: vertical
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
  for_each_face_in_band(
      scene, bottom_m, top_m, [&](std::size_t face, std::span<const Eigen::Vector3f> polygon) {
        using Place = std::pair<float, float>;
        const auto place = [&](std::size_t i) {
          const Eigen::Vector3f& corner = polygon[i % polygon.size()];
          return Place(corner.x(), corner.y());
        };
        const auto add = [&](const Place& from, const Place& to, bool left, bool right) {
          if (from != to)
            edges.push_back({.ends = {from.first, from.second, to.first, to.second},
                             .face = static_cast<std::uint32_t>(face),
                             .left = left,
                             .right = right});
        };
        const float area_m2 = doubled_area_m2(polygon);
        if (std::abs(area_m2) <= kUpright_m2) {  // a line, from its least point to its greatest
          Place least = place(0), greatest = place(0);
          for (std::size_t i = 1; i < polygon.size(); ++i) {
            least = std::min(least, place(i));
            greatest = std::max(greatest, place(i));
          }
          add(least, greatest, false, false);
          return;
        }
        for (std::size_t i = 0; i < polygon.size(); ++i) {
          const Place from = place(i), to = place(i + 1);
          if (from < to)
            add(from, to, area_m2 > 0, area_m2 < 0);
          else
            add(to, from, area_m2<0, area_m2> 0);
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
