// SPDX-License-Identifier: Apache-2.0
#include "robots/model/wheel_base.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/LU>

namespace mh {
namespace {

/// Tolerance for axles to count as parallel to each other or to the base's y: 1 degree, since URDFs
/// round pi / 2.
constexpr double kAskew = 0.0175;

/// @pre three wheels
Eigen::Matrix3d rims_from_twist(const WheelBase& wheels) {
  Eigen::Matrix3d rows;
  for (int i = 0; i < 3; ++i) {
    const WheelBase::Wheel& wheel = wheels.wheels[static_cast<std::size_t>(i)];
    // The rolling direction, perpendicular to the axle. When the base turns, the wheel moves at
    // turn x place.
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

std::string find_kind(WheelBase& base) {
  const std::vector<WheelBase::Wheel>& wheels = base.wheels;
  const auto parallel = [&](const WheelBase::Wheel& wheel) {
    return std::abs(std::sin(wheel.axle_rad - wheels.front().axle_rad)) < kAskew;
  };
  if (wheels.empty() || !std::ranges::all_of(wheels, parallel)) {
    if (wheels.size() != 3)
      return fmt::format(
          "has {} joints: an omnidirectional base has three, a differential one two (or more) on "
          "parallel axles",
          wheels.size());
    base.kind = WheelBase::Kind::kOmnidirectional;
    // The determinant is in meters. It is 0, for example, if all wheels roll toward one point,
    // about which the base then turns freely.
    if (std::abs(rims_from_twist(base).determinant()) < 1e-6)
      return "the axles of these wheels leave a direction in which no rim moves";
    return "";
  }
  if (std::abs(std::cos(wheels.front().axle_rad)) > kAskew)
    return "the axles of these wheels are parallel, but not to the base's y: it would not drive "
           "ahead";
  if (wheels.size() > kMostWheels)
    return fmt::format("has {} joints: a base may have at most {}", wheels.size(), kMostWheels);
  base.kind = WheelBase::Kind::kDifferential;
  base.middle_m.setZero();
  for (const WheelBase::Wheel& wheel : wheels)
    base.middle_m += wheel.place_m / static_cast<double>(wheels.size());
  const auto on_side = [&](double side) {
    constexpr double kLeast_m = 0.005;  // least lateral distance from the middle
    return std::ranges::count_if(wheels, [&](const WheelBase::Wheel& wheel) {
      return side * (wheel.place_m.y() - base.middle_m.y()) > kLeast_m;
    });
  };
  if (const auto left = on_side(1), right = on_side(-1);
      left != right || 2 * left != std::ssize(wheels))
    return fmt::format(
        "has {} joints on parallel axles, {} on the left and {} on the right: a differential base "
        "has the same number on each side",
        wheels.size(), left, right);
  return "";
}

PerWheel rim_speeds_m_per_s(const WheelBase& base, const Twist2d& twist) {
  PerWheel rims(base.wheels.size());
  if (base.kind == WheelBase::Kind::kOmnidirectional) {
    const Eigen::Vector3d three = rims_from_twist(base) * twist;
    rims << three.x(), three.y(), three.z();
    return rims;
  }
  for (std::size_t i = 0; i < base.wheels.size(); ++i)
    rims[static_cast<Eigen::Index>(i)] = twist.x() - twist.z() * base.wheels[i].place_m.y();
  return rims;
}

Twist2d twist_of_rims(const WheelBase& base, const PerWheel& rims_m_per_s) {
  if (base.kind == WheelBase::Kind::kOmnidirectional)
    return rims_from_twist(base).inverse() * Eigen::Vector3d(rims_m_per_s);
  double turned = 0, squares = 0;
  for (std::size_t i = 0; i < base.wheels.size(); ++i) {
    const double right_m = base.middle_m.y() - base.wheels[i].place_m.y();
    turned += right_m * rims_m_per_s[static_cast<Eigen::Index>(i)];
    squares += right_m * right_m;
  }
  return twist_of(base, rims_m_per_s.mean(), turned / squares);
}

Twist2d twist_of(const WheelBase& base, double ahead_m_per_s, double turn_rad_per_s) {
  return {ahead_m_per_s + turn_rad_per_s * base.middle_m.y(), -turn_rad_per_s * base.middle_m.x(),
          turn_rad_per_s};
}

double ahead_of(const WheelBase& base, const Twist2d& twist) {
  return twist.x() - twist.z() * base.middle_m.y();
}

JerkLimiter::JerkLimiter(const BaseLimits& limits, double step_s, const WheelBase* wheels)
    : limits_(limits), step_s_(step_s) {
  if (wheels == nullptr) return;
  most_m_per_s_ = wheels->max_rim_m_per_s;
  // When the base turns in place at 1 rad/s, a rim's speed equals its distance from the middle.
  const bool ahead_only = wheels->kind == WheelBase::Kind::kDifferential;
  reach_m_ = rim_speeds_m_per_s(*wheels, ahead_only ? twist_of(*wheels, 0, 1) : Twist2d(0, 0, 1))
                 .cwiseAbs()
                 .maxCoeff();
}

JerkLimiter::Velocity JerkLimiter::step(const Velocity& command) {
  const double jerk = limits_.max_jerk_m_per_s3.value_or(1e9);
  const double turn_jerk = limits_.max_turn_jerk_rad_per_s3.value_or(1e9);
  const double unit = jerk * step_s_, turn_unit = turn_jerk * step_s_;

  Eigen::Vector2d goal =
      limited(command.m_per_s, command.m_per_s.norm(), limits_.max_velocity_m_per_s);
  double turn_goal =
      std::clamp(command.turn_rad_per_s, -limits_.max_turn_rad_per_s, limits_.max_turn_rad_per_s);
  constexpr double kRimShare = 0.98;  // share of the rims' limit, so that a command is reachable
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

  // Reducing an acceleration to zero takes time, during which the speed keeps growing. A step
  // therefore takes the wanted acceleration only if reducing it from the next step on would still
  // end within the limits. Otherwise it reduces the acceleration now; the previous step made sure
  // that this stays within the limits.
  const auto gained = [this](double acceleration, double j,
                             bool has_limit) {  // speed gained while it is reduced
    if (!has_limit) return 0.0;
    return std::max(
        0.0, 0.5 * acceleration * (acceleration / j - step_s_) + 0.125 * j * step_s_ * step_s_);
  };
  const auto peak = [&](const Eigen::Vector2d& a) {
    const Eigen::Vector2d v = velocity_.m_per_s + a * step_s_;
    return std::max(
        v.norm(),
        (v + a.stableNormalized() * gained(a.norm(), jerk, limits_.max_jerk_m_per_s3.has_value()))
            .norm());
  };
  const auto turn_peak = [&](double a) {
    const double w = velocity_.turn_rad_per_s + a * step_s_;
    return std::max(std::abs(w),
                    std::abs(w + std::copysign(gained(std::abs(a), turn_jerk,
                                                      limits_.max_turn_jerk_rad_per_s3.has_value()),
                                               a)));
  };
  const double now = acceleration_m_per_s2_.norm();
  const Eigen::Vector2d shed = now > unit
                                   ? Eigen::Vector2d(acceleration_m_per_s2_ * (1 - unit / now))
                                   : Eigen::Vector2d::Zero();
  const double turn_shed =
      std::copysign(std::max(0.0, std::abs(turn_acceleration_rad_per_s2_) - turn_unit),
                    turn_acceleration_rad_per_s2_);
  // A shove may have made it faster than its limit: it must be able to slow down.
  const double speed = velocity_.m_per_s.norm();
  const double fastest = std::max(limits_.max_velocity_m_per_s * (1 + 1e-6), speed);
  const double most =
      std::max(most_m_per_s_, speed + reach_m_ * std::abs(velocity_.turn_rad_per_s));
  const auto fits = [&](const Eigen::Vector2d& a, double turn_a) {
    return peak(a) <= fastest && peak(a) + reach_m_ * turn_peak(turn_a) <= most;
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
