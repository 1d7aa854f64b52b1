// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/slice.hpp"

#include <array>

namespace mh {

std::vector<SliceSegment> slice(const Scene& scene, double height_m) {
  std::vector<SliceSegment> segments;
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    std::array<Eigen::Vector3d, 3> corner;
    for (std::size_t k = 0; k < 3; ++k)
      corner[k] = scene.positions_m[scene.triangles[face][k]].cast<double>();
    std::vector<Eigen::Vector2d> cuts;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d &a = corner[k], &b = corner[(k + 1) % 3];
      if ((a.z() < height_m) == (b.z() < height_m)) continue;
      const double t = (height_m - a.z()) / (b.z() - a.z());
      cuts.push_back((a + t * (b - a)).head<2>());
    }
    if (cuts.size() == 2) segments.push_back({cuts[0], cuts[1], scene.class_of[face]});
  }
  return segments;
}

}  // namespace mh
