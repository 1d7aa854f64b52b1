// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/se3.hpp"

namespace mh {

/// How far a pose may be off, one standard deviation along the worst axis.
struct PoseSigma {
  double position_m = 0, angle_rad = 0;
};
/// Of a pose's covariance (shift, turn; of the camera, in its own frame).
PoseSigma worst_sigma(const Matrix6d& covariance);

/// The camera's motion as a Kalman filter knows it: a twist that changes by white accelerations,
/// each tracked pose a measurement as good as its picture makes it. Twists and covariances are
/// those of the camera in its own frame (shift, turn), so that the map may move under it. A step
/// between frames turns so little that it leaves the covariances as they are.
struct Motion {
  Vector6d velocity_per_s;
  Matrix6d pose_covariance;           ///< m and rad
  Matrix6d pose_velocity_covariance;  ///< rows: pose, columns: velocity
  Matrix6d velocity_covariance;       ///< 1/s

  /// What the first pose tells: nothing of the velocity.
  static Motion at_rest(const Matrix6d& pose_covariance);
  /// Without a measurement, that long after.
  Motion after(double elapsed_s) const;
  SE3 predict(const SE3& camera_from_world, double elapsed_s) const {
    return SE3::exp(velocity_per_s * elapsed_s) * camera_from_world;
  }
  /// Takes in that the camera was seen off the prediction by a twist of this covariance.
  /// @pre *this is the motion after() the step. @returns the twist from prediction to best
  /// estimate.
  Vector6d correct(const Vector6d& seen_off, const Matrix6d& covariance);
};

}  // namespace mh
