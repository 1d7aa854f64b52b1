// SPDX-License-Identifier: Apache-2.0
#include "slam/track/inertial.hpp"

#include <utility>

#include <Eigen/Cholesky>

namespace mh {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kPlace = 0, kTurn = 3, kVelocity = 6, kGravity = 9, kTurnBias = 12, kForceBias = 15;

// Two to ten times the values in data sheets of cheap sensors, as is usual: neither the sensor's
// errors nor those of the poses are white noise.
constexpr double kGyroNoise = 1e-3, kGyroWalk = 1e-4;    // rad/s/sqrt(Hz), rad/s^2/sqrt(Hz)
constexpr double kAccelNoise = 1e-2, kAccelWalk = 3e-3;  // m/s^2/sqrt(Hz), m/s^3/sqrt(Hz)

constexpr double kAnySpeed_m_per_s = 2;
constexpr double kGyroOffset_rad_per_s = 0.03, kAccelOffset_m_per_s2 = 0.2;
constexpr double kShaken_m_per_s2 =
    1;  // how far the reading of a handheld accelerometer is from gravity
constexpr double kGravity_m_per_s2 = 9.81;

constexpr double kNanosecond_s = 1e-9, kLongestGap_s = 0.1;

void set_block(Matrix18d& covariance, int at, double sigma) {
  covariance.block<3, 3>(at, at) = Matrix3d::Identity() * (sigma * sigma);
}

/// One step with constant rates.
SE3 move_on(InertialMotion& motion, const Vector3d& turn_rad_per_s,
            const Vector3d& specific_force_m_per_s2, double t) {
  const Vector3d turn = turn_rad_per_s - motion.turn_bias_rad_per_s;
  const Vector3d acceleration =
      specific_force_m_per_s2 - motion.force_bias_m_per_s2 + motion.gravity_m_per_s2;
  const Vector3d way = motion.velocity_m_per_s * t + acceleration * (t * t / 2);
  const Matrix3d turned = so3_exp(turn * t), back = turned.transpose();
  motion.velocity_m_per_s = back * (motion.velocity_m_per_s + acceleration * t);
  motion.gravity_m_per_s2 = back * motion.gravity_m_per_s2;

  Matrix18d f = Matrix18d::Zero();
  for (const int at : {kPlace, kTurn, kVelocity, kGravity}) f.block<3, 3>(at, at) = back;
  f.block<3, 3>(kPlace, kTurn) = -back * hat(way);
  f.block<3, 3>(kPlace, kVelocity) = back * t;
  f.block<3, 3>(kPlace, kGravity) = back * (t * t / 2);
  f.block<3, 3>(kPlace, kForceBias) = -back * (t * t / 2);
  f.block<3, 3>(kTurn, kTurnBias) = -Matrix3d::Identity() * t;
  f.block<3, 3>(kVelocity, kGravity) = back * t;
  f.block<3, 3>(kVelocity, kForceBias) = -back * t;
  f.block<3, 3>(kVelocity, kTurnBias) = -hat(motion.velocity_m_per_s) * t;
  f.block<3, 3>(kGravity, kTurnBias) = -hat(motion.gravity_m_per_s2) * t;
  f.block<6, 6>(kTurnBias, kTurnBias).setIdentity();
  motion.covariance = f * motion.covariance * f.transpose();
  const auto add = [&](int at, double density) {
    motion.covariance.diagonal().segment<3>(at).array() += density * density * t;
  };
  add(kTurn, kGyroNoise);
  add(kVelocity, kAccelNoise);
  add(kTurnBias, kGyroWalk);
  add(kForceBias, kAccelWalk);
  return {turned, way};
}

}  // namespace

InertialMotion::Known InertialMotion::known(const SE3& camera_from_world) const {
  Matrix3d to_world = camera_from_world.rotation().transpose();
  Known known{to_world * gravity_m_per_s2, turn_bias_rad_per_s, force_bias_m_per_s2,
              covariance.bottomRightCorner<9, 9>()};
  known.covariance.topRows<3>() = to_world * known.covariance.topRows<3>();
  known.covariance.leftCols<3>() = known.covariance.leftCols<3>() * to_world.transpose();
  return known;
}

InertialMotion InertialMotion::begin(const ImuReading& reading, const Matrix6d& pose_covariance,
                                     const SE3& camera_from_world,
                                     const std::optional<Known>& known) {
  InertialMotion motion;
  motion.velocity_m_per_s.setZero();
  motion.before = reading;
  motion.covariance.setZero();
  motion.covariance.topLeftCorner<6, 6>() = pose_covariance;
  set_block(motion.covariance, kVelocity, kAnySpeed_m_per_s);
  if (known) {
    const Matrix3d& to_camera = camera_from_world.rotation();
    motion.gravity_m_per_s2 = to_camera * known->gravity_in_world_m_per_s2;
    motion.turn_bias_rad_per_s = known->turn_bias_rad_per_s;
    motion.force_bias_m_per_s2 = known->force_bias_m_per_s2;
    Eigen::Matrix<double, 9, 9> of_it = known->covariance;
    of_it.topRows<3>() = to_camera * of_it.topRows<3>();
    of_it.leftCols<3>() = of_it.leftCols<3>() * to_camera.transpose();
    motion.covariance.bottomRightCorner<9, 9>() = of_it;
    return motion;
  }
  motion.gravity_m_per_s2 = -kGravity_m_per_s2 * reading.specific_force_m_per_s2.stableNormalized();
  motion.turn_bias_rad_per_s.setZero();
  motion.force_bias_m_per_s2.setZero();
  set_block(motion.covariance, kGravity, kShaken_m_per_s2);
  set_block(motion.covariance, kTurnBias, kGyroOffset_rad_per_s);
  set_block(motion.covariance, kForceBias, kAccelOffset_m_per_s2);
  return motion;
}

std::optional<SE3> InertialMotion::advance(std::span<const ImuReading> readings, Stamp from_ns,
                                           Stamp to_ns) {
  SE3 before_from_now;  // transform between the filter's own poses
  Stamp at_ns = from_ns;
  const auto go_to = [&](Stamp stamp_ns, const Vector3d& turn, const Vector3d& force) {
    const double t = static_cast<double>(stamp_ns - at_ns) * kNanosecond_s;
    if (t <= 0) return true;
    if (t > kLongestGap_s) return false;
    before_from_now = before_from_now * move_on(*this, turn, force, t);
    at_ns = stamp_ns;
    return true;
  };
  for (const ImuReading& reading : readings) {
    const Stamp until_ns = std::min(reading.stamp_ns, to_ns);
    if (!go_to(until_ns, 0.5 * (before.turn_rad_per_s + reading.turn_rad_per_s),
               0.5 * (before.specific_force_m_per_s2 + reading.specific_force_m_per_s2)))
      return std::nullopt;
    before = reading;
  }
  if (!go_to(to_ns, before.turn_rad_per_s, before.specific_force_m_per_s2)) return std::nullopt;
  return before_from_now.inverse() * std::exchange(own_from_tracked, SE3());
}

void InertialMotion::correct(const Vector6d& seen_off, const Matrix6d& measured) {
  const Matrix6d sum = pose_covariance() + measured;
  const Eigen::Matrix<double, 18, 6> gain = sum.ldlt().solve(covariance.topRows<6>()).transpose();
  // The error of world_from_camera is the inverse of camera_from_world's twist.
  const Eigen::Matrix<double, 18, 1> off = gain * -seen_off;
  velocity_m_per_s += off.segment<3>(kVelocity);
  gravity_m_per_s2 += off.segment<3>(kGravity);
  turn_bias_rad_per_s += off.segment<3>(kTurnBias);
  force_bias_m_per_s2 += off.segment<3>(kForceBias);
  own_from_tracked = SE3::exp(-off.head<6>()) * SE3::exp(-seen_off);
  covariance -= gain * covariance.topRows<6>();
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
}

}  // namespace mh
