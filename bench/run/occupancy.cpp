// SPDX-License-Identifier: Apache-2.0
#include "bench/run/occupancy.hpp"

#include <algorithm>

namespace mh {
namespace {

/// Every fourth pixel of every fourth row: 3 cm apart at OccupancyConfig's range, within one voxel.
constexpr int kStep = 4;

Grid2d<float> thinned(const Grid2d<float>& depth_m) {
  Grid2d<float> small(depth_m.width() / kStep, depth_m.height() / kStep);
  for (int y = 0; y < small.height(); ++y)
    for (int x = 0; x < small.width(); ++x) small(x, y) = depth_m(kStep * x, kStep * y);
  return small;
}

/// The camera whose pixel (x, y) is pixel kStep (x, y) of the given one.
Camera thinned(Camera camera) {
  camera.width_px /= kStep;
  camera.height_px /= kStep;
  for (double* value : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px})
    *value /= kStep;
  return camera;
}

}  // namespace

void KeyframeDepths::keep(const RgbdFrame& frame) {
  const auto place =
      std::lower_bound(kept_.begin(), kept_.end(), frame.stamp_ns,
                       [](const Kept& kept, Stamp stamp) { return kept.stamp_ns < stamp; });
  Kept kept{frame.stamp_ns, thinned(frame.depth_m)};
  if (place != kept_.end() && place->stamp_ns == frame.stamp_ns)
    *place = std::move(kept);
  else
    kept_.insert(place, std::move(kept));
}

std::shared_ptr<const OccupancyMapper> KeyframeDepths::integrate(
    const Camera& camera, const Trajectory& estimate, const SE3& map_from_estimate) const {
  auto mapper = std::make_shared<OccupancyMapper>(OccupancyConfig{.stride_px = 1});
  const Camera small = thinned(camera);
  auto pose = estimate.begin();
  for (const Kept& kept : kept_) {
    while (pose != estimate.end() && pose->stamp_ns < kept.stamp_ns) ++pose;
    if (pose == estimate.end()) break;
    if (pose->stamp_ns == kept.stamp_ns)
      mapper->insert(kept.depth_m, small, map_from_estimate * pose->world_from_camera);
  }
  return mapper;
}

}  // namespace mh
