// SPDX-License-Identifier: Apache-2.0
#include "scenes/recorded/registered_depth.hpp"

#include <cassert>
#include <cmath>

namespace mh {

Grid2d<float> registered_depth(const Grid2d<float>& depth_m, const DepthCamera& depth,
                               const Camera& color) {
  assert(color.distortion.none() && depth.camera.distortion.none());
  Grid2d<float> registered(color.width_px, color.height_px);
  for (int y = 0; y < depth_m.height(); ++y)
    for (int x = 0; x < depth_m.width(); ++x) {
      const double z_m = static_cast<double>(depth_m(x, y));
      if (!(z_m > 0)) continue;
      const Eigen::Vector3d point = depth.color_from_depth * depth.camera.unproject(x, y, z_m);
      constexpr double kNearest_m = 1e-3;  // nearer than any camera measures
      if (!(point.z() > kNearest_m)) continue;
      const Eigen::Vector2d pixel = color.project(point);
      const double u = std::floor(pixel.x() + 0.5), v = std::floor(pixel.y() + 0.5);
      if (!color.in_image(u, v)) continue;
      float& seen_m = registered(static_cast<int>(u), static_cast<int>(v));
      const auto here_m = static_cast<float>(point.z());
      if (seen_m == 0.0F || here_m < seen_m) seen_m = here_m;
    }
  return registered;
}

}  // namespace mh
