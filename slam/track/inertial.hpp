// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

using Matrix18d = Eigen::Matrix<double, 18, 18>;

/// Error-state Kalman filter of the camera's motion, driven by an inertial sensor; tracked poses
/// are its measurements (Sola, "Quaternion kinematics for the error-state Kalman filter", 2017,
/// chapter 5, with errors in the camera's own frame). Everything is in the camera's frame, so a
/// change of the map does not invalidate the state.
struct InertialMotion {
  Eigen::Vector3d velocity_m_per_s;
  Eigen::Vector3d gravity_m_per_s2;  ///< downward
  Eigen::Vector3d turn_bias_rad_per_s, force_bias_m_per_s2;
  /// Covariance of position, rotation, velocity, gravity, and both biases, in this order.
  Matrix18d covariance;
  ImuReading before;  ///< the last reading
  SE3 own_from_tracked =
      {};  ///< from the last tracked pose to the filter's own, which uses all images

  /// What was learned about the sensor, to restart the filter when the map is found again.
  struct Known {
    Eigen::Vector3d gravity_in_world_m_per_s2;
    Eigen::Vector3d turn_bias_rad_per_s, force_bias_m_per_s2;
    Eigen::Matrix<double, 9, 9> covariance;
  };
  Known known(const SE3& camera_from_world) const;

  /// State at a pose about which nothing else is known: the velocity is unknown, and gravity is
  /// taken from the accelerometer unless a better value was learned before.
  static InertialMotion begin(const ImuReading& reading, const Matrix6d& pose_covariance,
                              const SE3& camera_from_world, const std::optional<Known>& known);

  /// Advances the state to a later time.
  /// @param readings  since the last update, in order
  /// @returns camera_now_from_camera_before, where the latter is the tracked pose; nullopt if
  /// readings are missing for too long
  std::optional<SE3> advance(std::span<const ImuReading> readings, Stamp from_ns, Stamp to_ns);

  Matrix6d pose_covariance() const { return covariance.topLeftCorner<6, 6>(); }
  /// Updates the state with a measured pose, which becomes the tracked one.
  /// @param seen_off    twist from the predicted camera_from_world to the measured one
  /// @param covariance  of the measurement
  void correct(const Vector6d& seen_off, const Matrix6d& covariance);
};

}  // namespace mh
