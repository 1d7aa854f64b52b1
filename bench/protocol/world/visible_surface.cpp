// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/world/visible_surface.hpp"

#include <algorithm>
#include <cmath>

namespace mh {
namespace {

constexpr int kWidth = 96, kSparseWidth = 32;
constexpr double kNearest_m = 0.05;

/// Whether a view shows a point, and not something in front of it. Depth is sampled coarsely: the
/// farthest of the four samples around the point decides.
bool shows(const Camera& camera, const Grid2d<float>& depth_m, const Eigen::Vector3d& in_camera) {
  if (in_camera.z() < kNearest_m) return false;
  const Eigen::Vector2d pixel = camera.project(in_camera);
  const auto x = static_cast<int>(std::floor(pixel.x())),
             y = static_cast<int>(std::floor(pixel.y()));
  if (pixel.x() < -0.5 || pixel.y() < -0.5 || pixel.x() >= camera.width_px - 0.5 ||
      pixel.y() >= camera.height_px - 0.5)
    return false;
  const double limit_m = in_camera.z() - std::max(0.08, 0.04 * in_camera.z());
  for (const int v : {y, y + 1})
    for (const int u : {x, x + 1}) {
      const float depth =
          depth_m(std::clamp(u, 0, camera.width_px - 1), std::clamp(v, 0, camera.height_px - 1));
      if (depth == 0 || depth >= limit_m) return true;
    }
  return false;
}

Camera of_width(const Camera& camera, int width_px) {
  const double height_px = static_cast<double>(width_px) / camera.width_px * camera.height_px;
  return resized(camera, width_px, std::max(1, static_cast<int>(std::lround(height_px))));
}

}  // namespace

VisibleSurface::VisibleSurface(std::shared_ptr<const Renderer> renderer, const Camera& camera,
                               const Trajectory& path, double apart_m)
    : camera_(of_width(camera, kWidth)), sparse_(of_width(camera, kSparseWidth)) {
  const SE3* last = nullptr;
  for (const TimedPose& pose : path) {
    const SE3& here = pose.world_from_camera;
    if (last != nullptr && pose_distance(here, *last) < apart_m) continue;
    last = &here;
    views_.push_back({here.inverse(), renderer->render(camera_, here).depth_m});
  }
}

double VisibleSurface::share(const Renderer& renderer, const SE3& world_from_camera) const {
  const Grid2d<float> depth_m = renderer.render(sparse_, world_from_camera).depth_m;
  std::size_t seen = 0, shown = 0;
  for (int y = 0; y < depth_m.height(); ++y)
    for (int x = 0; x < depth_m.width(); ++x) {
      if (depth_m(x, y) == 0) continue;
      ++seen;
      const Eigen::Vector3d point = world_from_camera * sparse_.unproject(x, y, depth_m(x, y));
      shown += std::ranges::any_of(views_, [&](const View& view) {
        return shows(camera_, view.depth_m, view.camera_from_world * point);
      });
    }
  return seen == 0 ? 0 : static_cast<double>(shown) / static_cast<double>(seen);
}

}  // namespace mh
