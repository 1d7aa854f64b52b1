// SPDX-License-Identifier: Apache-2.0
#include "slam/track/motion.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace mh {
namespace {

// Spectral densities of the accelerations: in 1/30 s the velocity changes by 0.03 m/s and 0.1 rad/s
// (1 m/s^2 and 3 rad/s^2, held for one frame). This is more than a robot's base or head
// accelerates, and about as much as a hand does.
constexpr double kShiftNoise = 1.0 / 30;  // m^2/s^3
constexpr double kTurnNoise = 9.0 / 30;   // rad^2/s^3

// Prior of an unknown velocity.
constexpr double kFastest_m_per_s = 2, kFastest_rad_per_s = 3;

Matrix6d diagonal(double shift, double turn) {
  Vector6d of;
  of << shift, shift, shift, turn, turn, turn;
  return of.asDiagonal();
}

}  // namespace

PoseSigma worst_sigma(const Matrix6d& covariance) {
  const auto worst = [](const Eigen::Matrix3d& block) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(block, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, axes.eigenvalues()[2]));
  };
  return {.position_m = worst(covariance.topLeftCorner<3, 3>()),
          .angle_rad = worst(covariance.bottomRightCorner<3, 3>())};
}

PoseSigma odometry_drift(double way_m, double turn_rad) {
  constexpr double kOfWay = 0.03, kWayOfTurn_m = 0.02, kOfTurn = 0.02, kTurnOfWay_per_m = 0.01;
  return {.position_m = kOfWay * way_m + kWayOfTurn_m * turn_rad,
          .angle_rad = kOfTurn * turn_rad + kTurnOfWay_per_m * way_m};
}

Motion Motion::at_rest(const Matrix6d& pose_covariance) {
  return {.velocity_per_s = Vector6d::Zero(),
          .pose_covariance = pose_covariance,
          .pose_velocity_covariance = Matrix6d::Zero(),
          .velocity_covariance = diagonal(kFastest_m_per_s * kFastest_m_per_s,
                                          kFastest_rad_per_s * kFastest_rad_per_s)};
}

Motion Motion::after(double t) const {
  const Matrix6d noise = diagonal(kShiftNoise, kTurnNoise);
  Motion next = *this;
  next.pose_covariance += t * (pose_velocity_covariance + pose_velocity_covariance.transpose()) +
                          t * t * velocity_covariance + t * t * t / 3 * noise;
  next.pose_velocity_covariance += t * velocity_covariance + t * t / 2 * noise;
  next.velocity_covariance += t * noise;
  return next;
}

Vector6d Motion::correct(const Vector6d& seen_off, const Matrix6d& covariance) {
  const Matrix6d sum = pose_covariance + covariance;
  const Eigen::LDLT<Matrix6d> factor(sum);
  const Matrix6d gain = factor.solve(pose_covariance).transpose();
  const Matrix6d velocity_gain = factor.solve(pose_velocity_covariance).transpose();
  velocity_per_s += velocity_gain * seen_off;
  velocity_covariance -= velocity_gain * pose_velocity_covariance;
  pose_velocity_covariance -= gain * pose_velocity_covariance;
  pose_covariance -= gain * pose_covariance;
  // Rounding must not make the covariances asymmetric.
  pose_covariance = 0.5 * (pose_covariance + pose_covariance.transpose()).eval();
  velocity_covariance = 0.5 * (velocity_covariance + velocity_covariance.transpose()).eval();
  return gain * seen_off;
}

}  // namespace mh
