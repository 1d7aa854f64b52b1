// SPDX-License-Identifier: Apache-2.0
#include "slam/track/rolling_shutter.hpp"

namespace mh {

void straighten(std::span<Keypoint> keypoints, const Camera& camera, const Vector6d& velocity_per_s,
                double readout_s) {
  if (readout_s == 0) return;
  constexpr double kNearest_m = 0.05;
  Vector6d turn = velocity_per_s;
  turn.head<3>().setZero();
  for (Keypoint& keypoint : keypoints) {
    const double after_s = ((keypoint.v_px + 0.5) / camera.height_px - 0.5) * readout_s;
    const bool has_depth = keypoint.depth_m > 0;
    const Eigen::Vector3d seen =
        camera.unproject(keypoint.u_px, keypoint.v_px, has_depth ? keypoint.depth_m : 1.0);
    const Eigen::Vector3d point = SE3::exp(-after_s * (has_depth ? velocity_per_s : turn)) * seen;
    if (point.z() < kNearest_m) continue;  // an implausible velocity
    const Eigen::Vector2d pixel = camera.project(point);
    keypoint.u_px = static_cast<float>(pixel.x());
    keypoint.v_px = static_cast<float>(pixel.y());
    if (has_depth) keypoint.depth_m = static_cast<float>(point.z());
  }
}

}  // namespace mh
