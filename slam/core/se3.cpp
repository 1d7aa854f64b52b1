// SPDX-License-Identifier: Apache-2.0
#include "slam/core/se3.hpp"

#include <cmath>

namespace mh {
namespace {

// Below this angle, the closed forms lose digits to cancellation; the second-order series is exact
// to double precision there.
constexpr double kSmallAngle_rad = 1e-5;

/// V of Barfoot (7.37): translation = V * rho.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d skew = hat(phi);
  if (angle < kSmallAngle_rad) return Eigen::Matrix3d::Identity() + 0.5 * skew + skew * skew / 6.0;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle)) / a2 * skew +
         (angle - std::sin(angle)) / (a2 * angle) * skew * skew;
}

}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d skew = hat(phi);
  if (angle < kSmallAngle_rad) return Eigen::Matrix3d::Identity() + skew + 0.5 * skew * skew;
  return Eigen::Matrix3d::Identity() + std::sin(angle) / angle * skew +
         (1.0 - std::cos(angle)) / (angle * angle) * skew * skew;
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation) {
  // Via the quaternion: stable at both ends, angle 0 and angle pi.
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-12) return 2.0 * q.vec();
  return 2.0 * std::atan2(sine, q.w()) / sine * q.vec();
}

SE3 SE3::exp(const Vector6d& tangent) {
  const Eigen::Vector3d rho = tangent.head<3>();
  const Eigen::Vector3d phi = tangent.tail<3>();
  return {so3_exp(phi), left_jacobian(phi) * rho};
}

Vector6d SE3::log() const {
  const Eigen::Vector3d phi = so3_log(rotation_);
  Vector6d tangent;
  tangent.head<3>().noalias() = left_jacobian(phi).partialPivLu().solve(translation_);
  tangent.tail<3>() = phi;
  return tangent;
}

double angle_between_rad(const SE3& a, const SE3& b) {
  return so3_log(a.rotation().transpose() * b.rotation()).norm();
}

double pose_distance(const SE3& a, const SE3& b) {
  return (a.translation() - b.translation()).norm() + angle_between_rad(a, b);
}

}  // namespace mh
