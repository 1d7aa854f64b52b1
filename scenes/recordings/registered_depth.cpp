// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/registered_depth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mh {
namespace {

/// The largest distance from the axis, at unit depth, up to which a lens's distortion is monotonic.
/// Beyond that, its polynomials fold the image.
double farthest_radius(const Distortion& distortion) {
  if (distortion.none()) return std::numeric_limits<double>::infinity();
  constexpr double kStep = 0.01, kMost = 10;  // 84 degrees off the axis
  double shown = 0;
  for (double r = kStep; r < kMost; r += kStep) {
    const double next = r * distortion.radial(r * r);
    if (!(next > shown)) return r - kStep;
    shown = next;
  }
  return kMost;
}

/// Computes the 3D points of a depth camera's pixels.
class Unprojector {
 public:
  explicit Unprojector(const Camera& camera) : camera_(camera) {}
  /// NaN where the lens maps no point to the pixel.
  Eigen::Vector3d operator()(int x, int y, double depth_m) const {
    if (camera_.distortion.none()) return camera_.unproject(x, y, depth_m);
    const Eigen::Vector2d ray = camera_.distortion.undistorted((x - camera_.cx_px) / camera_.fx_px,
                                                               (y - camera_.cy_px) / camera_.fy_px);
    return {ray.x() * depth_m, ray.y() * depth_m, depth_m};
  }

 private:
  const Camera& camera_;
};

/// The color camera's image while it is filled with depth.
class Registered {
 public:
  Registered(const Camera& color, const Camera& depth)
      : color_(color),
        half_x_(std::max(0.5, 0.5 * color.fx_px / depth.fx_px)),
        half_y_(std::max(0.5, 0.5 * color.fy_px / depth.fy_px)),
        farthest_(farthest_radius(color.distortion)),
        depth_m_(color.width_px, color.height_px) {}

  void add(const Eigen::Vector3d& point) {
    constexpr double kNearest_m = 1e-3;  // nearer than any camera measures
    if (!(point.z() > kNearest_m)) return;
    const Eigen::Vector2d pixel = seen_at(point);
    const Range x = covered(pixel.x(), half_x_, color_.width_px),
                y = covered(pixel.y(), half_y_, color_.height_px);
    const auto here_m = static_cast<float>(point.z());
    for (int v = y.first; v <= y.last; ++v)
      for (int u = x.first; u <= x.last; ++u) {
        float& seen_m = depth_m_(u, v);
        if (seen_m == 0.0F || here_m < seen_m) seen_m = here_m;
      }
  }
  Grid2d<float> take() { return std::move(depth_m_); }

 private:
  struct Range {
    int first = 0, last = -1;
  };

  /// NaN where the lens shows nothing.
  Eigen::Vector2d seen_at(const Eigen::Vector3d& point) const {
    if (color_.distortion.none()) return color_.project(point);
    const double x = point.x() / point.z(), y = point.y() / point.z();
    if (!(std::hypot(x, y) < farthest_))
      return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    const Eigen::Vector2d bent = color_.distortion.distorted(x, y);
    return {color_.fx_px * bent.x() + color_.cx_px, color_.fy_px * bent.y() + color_.cy_px};
  }

  /// The pixels from `at` - `half` up to but excluding `at` + `half`.
  static Range covered(double at, double half, int size) {
    const double last = half > 0.5 ? std::ceil(at + half) - 1 : std::floor(at + 0.5);
    const double first = half > 0.5 ? std::ceil(at - half) : last;
    if (!(last >= 0 && first <= size - 1)) return {};
    return {static_cast<int>(std::max(first, 0.0)), static_cast<int>(std::min(last, size - 1.0))};
  }

  const Camera& color_;
  double half_x_, half_y_;  ///< half the size of a depth pixel, in color pixels
  double farthest_;
  Grid2d<float> depth_m_;
};

}  // namespace

Grid2d<float> registered_depth(const Grid2d<float>& depth_m, const DepthCamera& depth,
                               const Camera& color) {
  const Unprojector unproject(depth.camera);
  Registered registered(color, depth.camera);
  for (int y = 0; y < depth_m.height(); ++y)
    for (int x = 0; x < depth_m.width(); ++x) {
      const double z_m = static_cast<double>(depth_m(x, y));
      if (z_m > 0) registered.add(depth.color_from_depth * unproject(x, y, z_m));
    }
  return registered.take();
}

}  // namespace mh
