// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/se3.hpp"

namespace mh {

/// Pose uncertainty: one standard deviation along the worst axis.
struct PoseSigma {
  double position_m = 0, angle_rad = 0;
};
/// Extracts it from a pose covariance (translation, rotation; of the camera, in its own frame).
PoseSigma worst_sigma(const Matrix6d& covariance);

/// Drift of a wheeled base's odometry over a path length and a turn, one standard deviation.
PoseSigma odometry_drift(double way_m, double turn_rad);

/// Kalman filter of the camera's motion: constant velocity with white-noise acceleration; each
/// tracked pose is a measurement with the covariance computed from its image. Twists and
/// covariances are those of the camera in its own frame (translation, rotation), so a change of the
/// map does not invalidate them. The rotation between frames is so small that covariances are not
/// rotated.
struct Motion {
  Vector6d velocity_per_s;
  Matrix6d pose_covariance;           ///< m and rad
  Matrix6d pose_velocity_covariance;  ///< rows: pose, columns: velocity
  Matrix6d velocity_covariance;       ///< m/s and rad/s

  /// State after the first pose: velocity unknown.
  static Motion at_rest(const Matrix6d& pose_covariance);
  /// Prediction without a measurement, after this time.
  Motion after(double elapsed_s) const;
  SE3 predict(const SE3& camera_from_world, double elapsed_s) const {
    return SE3::exp(velocity_per_s * elapsed_s) * camera_from_world;
  }
  /// Updates the state with a measured pose.
  /// @param seen_off    twist from the predicted to the measured pose
  /// @param covariance  of the measurement
  /// @pre *this is the prediction that after() returned.
  /// @returns the twist from prediction to best estimate.
  Vector6d correct(const Vector6d& seen_off, const Matrix6d& covariance);
};

}  // namespace mh
