// SPDX-License-Identifier: Apache-2.0
#include "robots/model/odometry.hpp"

#include <cmath>

#include "robots/model/wheel_base.hpp"
#include "slam/core/random.hpp"

namespace mh {

Trajectory wheel_odometry(const Trajectory& base, const OmniWheels& wheels,
                          const OdometryErrors& errors, std::uint64_t seed) {
  const RandomStream stream = RandomStream(seed).fork(0x6f646f6d);
  Eigen::Vector3d scale;
  for (int w = 0; w < 3; ++w)
    scale[w] = (1 + errors.scale) *
               (1 + errors.scale_spread * stream.fork(0).normal(static_cast<std::uint64_t>(w)));
  Trajectory odometry;
  SE3 odom_from_base;
  for (std::size_t i = 0; i < base.size(); ++i) {
    if (i == 0) {
      odom_from_base = base[0].world_from_camera;
    } else {
      // tangent: translation, then rotation; the base moves in the plane.
      const Vector6d moved =
          (base[i - 1].world_from_camera.inverse() * base[i].world_from_camera).log();
      Eigen::Vector3d rims_m =
          rim_speeds_m_per_s(wheels, {moved[0], moved[1], moved[5]});  // of a step that lasts 1 s
      for (int w = 0; w < 3; ++w) {
        const double slip = errors.slip_per_sqrt_m * std::sqrt(std::abs(rims_m[w])) *
                            stream.fork(1 + i).normal(static_cast<std::uint64_t>(w));
        rims_m[w] = rims_m[w] * scale[w] + slip;
      }
      const Twist2d read = twist_of_rims(wheels, rims_m);
      Vector6d step = Vector6d::Zero();
      step[0] = read.x();
      step[1] = read.y();
      step[5] = read.z();
      odom_from_base = (odom_from_base * SE3::exp(step)).normalized();
    }
    odometry.push_back({base[i].stamp_ns, odom_from_base});
  }
  return odometry;
}

}  // namespace mh
