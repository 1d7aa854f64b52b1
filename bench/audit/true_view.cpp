// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/true_view.hpp"

#include <algorithm>
#include <cmath>

#include "sim/sensors/lens.hpp"

namespace mh {
namespace {

double tolerance_m(double depth_m) {
  return std::max(kSamePoint_m, kSamePointShare * depth_m);
}

/// The depth at a pixel; where the 3x3 pixels around it show two surfaces, the depth of the nearer
/// one.
float nearest_surface_m(const Grid2d<float>& depth_m, int x, int y) {
  constexpr float kSameSurface = 1.05F;  // ratio of depths, as in SLAM's features
  float nearest = 0, farthest = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, depth_m.height() - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, depth_m.width() - 1); ++u) {
      const float depth = depth_m(u, v);
      if (depth <= 0) continue;
      nearest = nearest == 0 ? depth : std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
  const float own = depth_m(x, y);
  return own > 0 && farthest < kSameSurface * nearest ? own : nearest;
}

bool is_at_border(const Grid2d<ClassId>& classes, int x, int y) {
  for (int v = std::max(y - kBorder_px, 0); v <= std::min(y + kBorder_px, classes.height() - 1);
       ++v)
    for (int u = std::max(x - kBorder_px, 0); u <= std::min(x + kBorder_px, classes.width() - 1);
         ++u)
      if (classes(u, v) != classes(x, y)) return true;
  return false;
}

}  // namespace

// Undistorted keypoints may be outside the image's rectangle; the wide camera sees these, too.
TrueCamera::TrueCamera(const Camera& known) : camera(known), wide(Lens(known).pinhole()) {
  camera.distortion = {};
}

TrueView look(const Renderer& renderer, const TrueCamera& cameras, const SE3& world_from_camera,
              const Features& features) {
  const auto& [camera, wide] = cameras;
  const RenderedFrame exact = renderer.render(wide, world_from_camera);
  TrueView view{.world_from_camera = world_from_camera,
                .camera = camera,
                .depth_m = Grid2d<float>((camera.width_px - 1) / TrueView::kStep + 1,
                                         (camera.height_px - 1) / TrueView::kStep + 1),
                .points = {}};
  const auto pixel_of = [&](double u_px, double v_px) -> std::optional<Eigen::Vector2i> {
    const Eigen::Vector2d in_wide = wide.project(camera.unproject(u_px, v_px, 1.0));
    const Eigen::Vector2i pixel(static_cast<int>(std::lround(in_wide.x())),
                                static_cast<int>(std::lround(in_wide.y())));
    if (!exact.depth_m.contains(pixel.x(), pixel.y())) return std::nullopt;
    return pixel;
  };
  for (int y = 0; y < view.depth_m.height(); ++y)
    for (int x = 0; x < view.depth_m.width(); ++x)
      if (const auto pixel = pixel_of(x * TrueView::kStep, y * TrueView::kStep))
        view.depth_m(x, y) = exact.depth_m(pixel->x(), pixel->y());
  for (const Keypoint& k : features.keypoints) {
    auto& point = view.points.emplace_back();
    const auto pixel = pixel_of(k.u_px, k.v_px);
    if (!pixel) continue;
    const float depth_m = nearest_surface_m(exact.depth_m, pixel->x(), pixel->y());
    if (depth_m <= 0) continue;
    point = TruePoint{world_from_camera * camera.unproject(k.u_px, k.v_px, depth_m), depth_m,
                      is_at_border(exact.classes, pixel->x(), pixel->y())};
  }
  return view;
}

bool same_place(const TruePoint& a, const TruePoint& b) {
  return (a.in_world - b.in_world).norm() <= tolerance_m(a.depth_m);
}

double co_visible_share(const TrueView& view, const TrueView& other) {
  constexpr int kEvery = 2;  // every second sample of the stored depth: 8 px
  const SE3 other_from_view = other.world_from_camera.inverse() * view.world_from_camera;
  int seen = 0, shared = 0;
  for (int y = 0; y < view.depth_m.height(); y += kEvery)
    for (int x = 0; x < view.depth_m.width(); x += kEvery) {
      const double depth_m = view.depth_m(x, y);
      if (depth_m <= 0) continue;
      ++seen;
      const Eigen::Vector3d point =
          other_from_view *
          view.camera.unproject(x * TrueView::kStep, y * TrueView::kStep, depth_m);
      if (point.z() <= 0) continue;
      const Eigen::Vector2d pixel = other.camera.project(point);
      // The nearest sample of the stored depth, if within half a sample of the image.
      const double u = std::round(pixel.x() / TrueView::kStep),
                   v = std::round(pixel.y() / TrueView::kStep);
      if (!(u >= 0 && v >= 0 && u < other.depth_m.width() && v < other.depth_m.height())) continue;
      const double there_m = other.depth_m(static_cast<int>(u), static_cast<int>(v));
      shared += there_m > 0 && std::abs(there_m - point.z()) <= tolerance_m(point.z());
    }
  return seen == 0 ? 0.0 : static_cast<double>(shared) / seen;
}

}  // namespace mh
