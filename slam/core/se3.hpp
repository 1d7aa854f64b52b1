// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace mh {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// so(3) -> 3x3 skew-symmetric matrix: hat(a) * b == a.cross(b).
Eigen::Matrix3d hat(const Eigen::Vector3d& v);

/// Rotation matrix of a rotation vector (rad); Rodrigues' formula.
Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_vector_rad);
/// Rotation vector (rad, norm at most pi) of a rotation matrix.
Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation);

/// A rigid transform, named target_from_source: point_in_target = target_from_source *
/// point_in_source. Tangent vectors are (translation part rho, rotation part phi), Barfoot, "State
/// Estimation for Robotics", section 7.1.
class SE3 {
 public:
  SE3() : rotation_(Eigen::Matrix3d::Identity()), translation_(Eigen::Vector3d::Zero()) {}
  SE3(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation_m)
      : rotation_(rotation), translation_(translation_m) {}
  /// The quaternion is normalized first.
  SE3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation_m)
      : rotation_(rotation.normalized().toRotationMatrix()), translation_(translation_m) {}

  static SE3 exp(const Vector6d& tangent);
  Vector6d log() const;

  SE3 inverse() const { return {rotation_.transpose(), -(rotation_.transpose() * translation_)}; }
  /// This transform with its rotation made orthonormal again (after long products).
  SE3 normalized() const { return {Eigen::Quaterniond(rotation_), translation_}; }

  const Eigen::Matrix3d& rotation() const { return rotation_; }
  const Eigen::Vector3d& translation() const { return translation_; }
  Eigen::Quaterniond quaternion() const { return Eigen::Quaterniond(rotation_).normalized(); }
  /// x y z (m), then the unit quaternion x y z w: the order of TUM's trajectories.
  std::array<double, 7> numbers() const {
    const Eigen::Quaterniond q = quaternion();
    return {translation_.x(), translation_.y(), translation_.z(), q.x(), q.y(), q.z(), q.w()};
  }

  friend SE3 operator*(const SE3& a, const SE3& b) {
    return {a.rotation_ * b.rotation_, a.rotation_ * b.translation_ + a.translation_};
  }
  friend Eigen::Vector3d operator*(const SE3& a, const Eigen::Vector3d& point) {
    return a.rotation_ * point + a.translation_;
  }

 private:
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d translation_;
};

/// Angle (rad) of the rotation between two orientations, in [0, pi].
double angle_between_rad(const SE3& a, const SE3& b);

/// Distance between two poses in position and rotation together: 1 rad counts as 1 m.
double pose_distance(const SE3& a, const SE3& b);

}  // namespace mh
