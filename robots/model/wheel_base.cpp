// SPDX-License-Identifier: Apache-2.0
#include "robots/model/wheel_base.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

namespace mh {
namespace {

Eigen::Matrix3d rims_from_twist(const OmniWheels& wheels) {
  Eigen::Matrix3d rows;
  for (int i = 0; i < 3; ++i) {
    const OmniWheels::Wheel& wheel = wheels.wheels[static_cast<std::size_t>(i)];
    // Perpendicular to the axle; as the base turns, the wheel's place moves by turn x place.
    const Eigen::Vector2d drive(-std::sin(wheel.axle_rad), std::cos(wheel.axle_rad));
    rows.row(i) << drive.x(), drive.y(),
        wheel.place_m.x() * drive.y() - wheel.place_m.y() * drive.x();
  }
  return rows;
}

/// The largest acceleration toward a goal `distance` away (in velocity) such that reducing it by
/// jerk * step in each step ends exactly at the goal: with n steps, distance = jerk step^2 n (n +
/// 1)/2.
double braking_acceleration(double distance, double jerk, double step_s) {
  const double unit = jerk * step_s * step_s;
  const double steps = std::sqrt(0.25 + 2 * distance / unit) - 0.5;
  return jerk * step_s * steps;
}

template <class Vector>
Vector limited(const Vector& v, double size, double limit) {
  return size > limit ? Vector(v * (limit / size)) : v;
}

}  // namespace

Eigen::Vector3d rim_speeds_m_per_s(const OmniWheels& wheels, const Twist2d& twist) {
  return rims_from_twist(wheels) * twist;
}

Twist2d twist_of_rims(const OmniWheels& wheels, const Eigen::Vector3d& rims_m_per_s) {
  return rims_from_twist(wheels).inverse() * rims_m_per_s;
}

JerkLimiter::JerkLimiter(const BaseLimits& limits, double step_s, const OmniWheels* wheels)
    : limits_(limits), step_s_(step_s) {
  if (wheels == nullptr) return;
  most_m_per_s_ = wheels->max_rim_m_per_s;
  reach_m_ = rims_from_twist(*wheels).col(2).cwiseAbs().maxCoeff();
}

JerkLimiter::Velocity JerkLimiter::step(const Velocity& command) {
  const double jerk = limits_.max_jerk_m_per_s3.value_or(1e9);
  const double turn_jerk = limits_.max_turn_jerk_rad_per_s3.value_or(1e9);
  const double unit = jerk * step_s_, turn_unit = turn_jerk * step_s_;

  Eigen::Vector2d goal =
      limited(command.m_per_s, command.m_per_s.norm(), limits_.max_velocity_m_per_s);
  double turn_goal =
      std::clamp(command.turn_rad_per_s, -limits_.max_turn_rad_per_s, limits_.max_turn_rad_per_s);
  constexpr double kRimShare = 0.98;  // of the rims' limit, so that a command is reachable
  const double asked = goal.norm() + reach_m_ * std::abs(turn_goal);
  if (asked > kRimShare * most_m_per_s_) {
    goal *= kRimShare * most_m_per_s_ / asked;
    turn_goal *= kRimShare * most_m_per_s_ / asked;
  }

  const Eigen::Vector2d left = goal - velocity_.m_per_s;
  const double size = left.norm();
  Eigen::Vector2d wanted = Eigen::Vector2d::Zero();
  if (size > 0)
    wanted = left / size *
             std::min({limits_.max_acceleration_m_per_s2, size / step_s_,
                       braking_acceleration(size, jerk, step_s_)});
  const Eigen::Vector2d change = wanted - acceleration_m_per_s2_;
  const Eigen::Vector2d next = acceleration_m_per_s2_ + limited(change, change.norm(), unit);

  const double turn_left = turn_goal - velocity_.turn_rad_per_s;
  const double turn_wanted = std::copysign(
      std::min({limits_.max_turn_acceleration_rad_per_s2, std::abs(turn_left) / step_s_,
                braking_acceleration(std::abs(turn_left), turn_jerk, step_s_)}),
      turn_left);
  const double turn_next =
      turn_acceleration_rad_per_s2_ +
      std::clamp(turn_wanted - turn_acceleration_rad_per_s2_, -turn_unit, turn_unit);

  // Turning the acceleration aside takes time in which the speed keeps growing: it starts only if
  // reducing the acceleration directly would still end within the limits. Otherwise it is reduced
  // now; the previous step made sure that there is enough time for that.
  const auto gained = [this](double acceleration, double j) {  // while it is reduced
    return std::max(
        0.0, 0.5 * acceleration * (acceleration / j - step_s_) + 0.125 * j * step_s_ * step_s_);
  };
  const auto peak = [&](const Eigen::Vector2d& a) {
    const Eigen::Vector2d v = velocity_.m_per_s + a * step_s_;
    return std::max(v.norm(), (v + a.stableNormalized() * gained(a.norm(), jerk)).norm());
  };
  const auto turn_peak = [&](double a) {
    const double w = velocity_.turn_rad_per_s + a * step_s_;
    return std::max(std::abs(w), std::abs(w + std::copysign(gained(std::abs(a), turn_jerk), a)));
  };
  const double now = acceleration_m_per_s2_.norm();
  const Eigen::Vector2d shed = now > unit
                                   ? Eigen::Vector2d(acceleration_m_per_s2_ * (1 - unit / now))
                                   : Eigen::Vector2d::Zero();
  const double turn_shed =
      std::copysign(std::max(0.0, std::abs(turn_acceleration_rad_per_s2_) - turn_unit),
                    turn_acceleration_rad_per_s2_);
  const auto fits = [&](const Eigen::Vector2d& a, double turn_a) {
    return peak(a) <= limits_.max_velocity_m_per_s * (1 + 1e-6) &&
           peak(a) + reach_m_ * turn_peak(turn_a) <= most_m_per_s_;
  };
  const std::array<std::pair<Eigen::Vector2d, double>, 4> choices = {
      {{next, turn_next}, {next, turn_shed}, {shed, turn_next}, {shed, turn_shed}}};
  std::size_t choice = 0;
  while (choice + 1 < choices.size() && !fits(choices[choice].first, choices[choice].second))
    ++choice;
  acceleration_m_per_s2_ = choices[choice].first;
  turn_acceleration_rad_per_s2_ = choices[choice].second;
  velocity_.m_per_s += acceleration_m_per_s2_ * step_s_;
  velocity_.turn_rad_per_s += turn_acceleration_rad_per_s2_ * step_s_;
  return velocity_;
}

void JerkLimiter::stopped_at(const Velocity& velocity) {
  velocity_ = velocity;
  acceleration_m_per_s2_.setZero();
  turn_acceleration_rad_per_s2_ = 0;
}

}  // namespace mh
