// SPDX-License-Identifier: Apache-2.0
#include "robots/model/odometry.hpp"

#include <cmath>

namespace mh {

WheelOdometer::WheelOdometer(const WheelBase& wheels, const OdometryErrors& errors,
                             std::uint64_t seed)
    : wheels_(wheels),
      errors_(errors),
      stream_(RandomStream(seed).fork(0x6f646f6d)),
      scale_(wheels.wheels.size()) {
  for (Eigen::Index w = 0; w < scale_.size(); ++w)
    scale_[w] = (1 + errors.scale) *
                (1 + errors.scale_spread * stream_.fork(0).normal(static_cast<std::uint64_t>(w)));
}

const SE3& WheelOdometer::drive_to(const SE3& world_from_base) {
  if (!before_) {
    odom_from_base_ = world_from_base;
  } else {
    // tangent: translation, then rotation; the base moves in the plane.
    const Vector6d moved = (before_->inverse() * world_from_base).log();
    PerWheel rims_m =
        rim_speeds_m_per_s(wheels_, {moved[0], moved[1], moved[5]});  // of a step of 1 s
    for (Eigen::Index w = 0; w < rims_m.size(); ++w) {
      const double slip = errors_.slip_per_sqrt_m * std::sqrt(std::abs(rims_m[w])) *
                          stream_.fork(1 + step_).normal(static_cast<std::uint64_t>(w));
      rims_m[w] = rims_m[w] * scale_[w] + slip;
    }
    const Twist2d read = twist_of_rims(wheels_, rims_m);
    Vector6d step = Vector6d::Zero();
    step[0] = read.x();
    step[1] = read.y();
    step[5] = read.z();
    odom_from_base_ = (odom_from_base_ * SE3::exp(step)).normalized();
  }
  before_ = world_from_base;
  ++step_;
  return odom_from_base_;
}

Trajectory wheel_odometry(const Trajectory& base, const WheelBase& wheels,
                          const OdometryErrors& errors, std::uint64_t seed) {
  WheelOdometer odometer(wheels, errors, seed);
  Trajectory odometry;
  for (const TimedPose& pose : base)
    odometry.push_back({pose.stamp_ns, odometer.drive_to(pose.world_from_camera)});
  return odometry;
}

}  // namespace mh
