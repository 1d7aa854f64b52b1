// SPDX-License-Identifier: Apache-2.0
#include "slam/track/dead_reckon.hpp"

#include <algorithm>

#include "slam/config/slam.hpp"

namespace mh {
namespace {

bool is_sure(const Matrix6d& covariance, const TrackConfig& config) {
  const PoseSigma sigma = worst_sigma(covariance);
  return sigma.position_m <= config.sure_position_m && sigma.angle_rad <= config.sure_angle_rad;
}

}  // namespace

int points_with_depth(const Features& features) {
  return static_cast<int>(std::count_if(features.keypoints.begin(), features.keypoints.end(),
                                        [](const Keypoint& k) { return k.depth_m > 0; }));
}

bool Reckoned::allows(const TrackedPose& tracked, const TrackConfig& config) const {
  constexpr double kMostChi2 = 30;  // with 6 degrees of freedom, one in 20,000 is larger
  constexpr double kMostSlip_m = 0.1, kMostSlip_rad = 0.1;
  const Vector6d off = (tracked.camera_from_world * camera_from_world.inverse()).log();
  if (tracked.inliers >= 5 * config.min_inliers && off.head<3>().norm() <= kMostSlip_m &&
      off.tail<3>().norm() <= kMostSlip_rad)
    return true;
  const Matrix6d sum = covariance + tracked.information.inverse();
  return off.dot(sum.ldlt().solve(off)) <= kMostChi2;
}

void fuse_with_prediction(Located& located, const Tracker& tracker, Stamp stamp_ns,
                          const std::optional<Reckoned>& reckoned, const TrackConfig& config) {
  const Matrix6d covariance = located.tracked.information.inverse();
  const double elapsed_s = seconds_since_last(tracker, stamp_ns);
  if (!reckoned && (!tracker.motion || elapsed_s <= 0)) {
    located.motion = Motion::at_rest(covariance);
    return;
  }
  SE3& pose = located.tracked.camera_from_world;
  const SE3 predicted = reckoned
                            ? reckoned->camera_from_world
                            : tracker.motion->predict(tracker.last->camera_from_world, elapsed_s);
  Motion motion =
      reckoned ? Motion::at_rest(reckoned->covariance) : tracker.motion->after(elapsed_s);
  const Vector6d off = motion.correct((pose * predicted.inverse()).log(), covariance);
  located.tracked.unsure = !is_sure(covariance, config);
  if (located.tracked.unsure) pose = SE3::exp(off) * predicted;
  located.motion = motion;
}

namespace {

// The map itself moves by this much from frame to frame.
constexpr double kMap_m = 0.005, kMap_rad = 0.005;

Matrix6d with_map(Matrix6d covariance) {
  covariance.diagonal().head<3>().array() += kMap_m * kMap_m;
  covariance.diagonal().tail<3>().array() += kMap_rad * kMap_rad;
  return covariance;
}

Reckoning longer(const Reckoning& before, const SE3& step) {
  const Vector6d twist = step.log();
  return {before.distance_m + twist.head<3>().norm(), before.turn_rad + twist.tail<3>().norm()};
}

std::optional<Reckoned> reckon_by_odometry(const Tracker& tracker,
                                           const std::optional<SE3>& odom_from_camera,
                                           const TrackConfig& config) {
  const std::optional<SE3> step = odometry_step(tracker, odom_from_camera);
  if (!step) return std::nullopt;
  Reckoned found;
  found.reckoning = longer(tracker.reckoning, *step);
  const auto [position_m, angle_rad] =
      odometry_drift(found.reckoning.distance_m, found.reckoning.turn_rad);
  if (position_m > config.reckon_position_m || angle_rad > config.reckon_angle_rad)
    return std::nullopt;
  found.camera_from_world = *step * tracker.last->camera_from_world;
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(position_m * position_m),
      Eigen::Vector3d::Constant(angle_rad * angle_rad);
  found.covariance = with_map(variances.asDiagonal());
  if (tracker.reckoning.is_zero() && tracker.motion)
    found.covariance += tracker.motion->pose_covariance;
  return found;
}

std::optional<Reckoned> reckon_by_imu(const Tracker& tracker, Stamp stamp_ns,
                                      std::span<const ImuReading> imu, const TrackConfig& config) {
  if (!tracker.inertial || imu.empty()) return std::nullopt;
  Reckoned found;
  found.inertial = tracker.inertial;
  const auto step = found.inertial->advance(imu, tracker.last->stamp_ns, stamp_ns);
  if (!step) return std::nullopt;
  const PoseSigma sigma = worst_sigma(found.inertial->pose_covariance());
  if (sigma.position_m > config.reckon_position_m || sigma.angle_rad > config.reckon_angle_rad)
    return std::nullopt;
  found.reckoning = longer(tracker.reckoning, *step);
  found.camera_from_world = *step * tracker.last->camera_from_world;
  found.covariance = with_map(found.inertial->pose_covariance());
  return found;
}

}  // namespace

std::optional<Reckoned> reckon(const Tracker& tracker, Stamp stamp_ns,
                               const std::optional<SE3>& odom_from_camera,
                               std::span<const ImuReading> imu, const TrackConfig& config) {
  if (!tracker.last) return std::nullopt;
  const auto by_odometry = reckon_by_odometry(tracker, odom_from_camera, config);
  return by_odometry ? by_odometry : reckon_by_imu(tracker, stamp_ns, imu, config);
}

void follow_inertially(Located& located, const std::optional<Reckoned>& reckoned,
                       std::span<const ImuReading> imu, const Tracker& tracker) {
  const SE3& pose = located.tracked.camera_from_world;
  if (!located.reckoning.is_zero()) {
    located.inertial = reckoned->inertial;
    return;
  }
  if (imu.empty()) return;
  const Matrix6d measured = with_map(located.tracked.information.inverse());
  if (reckoned && reckoned->inertial) {
    located.inertial = reckoned->inertial;
    if (located.tracked.unsure)  // the pose already includes the prediction
      located.inertial->own_from_tracked = reckoned->camera_from_world * pose.inverse();
    else
      located.inertial->correct((pose * reckoned->camera_from_world.inverse()).log(), measured);
  } else {
    located.inertial = InertialMotion::begin(imu.back(), measured, pose, tracker.inertial_known);
  }
}

std::optional<Located> dead_reckon(const Tracker& tracker, Stamp stamp_ns, const Features& features,
                                   const SlamContext& context) {
  const TrackConfig& config = context.config.track;
  if (!tracker.tracking() || !tracker.motion) return std::nullopt;
  if (points_with_depth(features) < config.min_inliers) return std::nullopt;
  const double elapsed_s = seconds_since_last(tracker, stamp_ns);
  const Motion motion = tracker.motion->after(elapsed_s);
  const SE3 guess = tracker.motion->predict(tracker.last->camera_from_world, elapsed_s);
  if (!is_sure(motion.pose_covariance, config)) return std::nullopt;
  if (count_that_can_be_found(*tracker.last, guess, context.map, context.camera) >=
      config.min_inliers)
    return std::nullopt;
  Located located;
  located.tracked.camera_from_world = guess;
  located.tracked.landmarks.resize(features.size());
  located.reference = context.map.live_keyframe(tracker.reference);
  located.motion = motion;
  return located;
}

}  // namespace mh
