// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/commanded_base.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {
namespace {

Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle_rad) {
  return {std::cos(angle_rad) * v.x() - std::sin(angle_rad) * v.y(),
          std::sin(angle_rad) * v.x() + std::cos(angle_rad) * v.y()};
}

}  // namespace

CommandedBase::CommandedBase(const Scene& scene, const Robot& robot, const Eigen::Vector2d& start_m,
                             double start_heading_rad, bool reflex)
    : robot_(robot),
      steps_per_frame_(static_cast<int>(std::ceil(kStepRate_hz / robot.camera.rate_hz))),
      world_(scene, robot_, start_m, start_heading_rad,
             1.0 / (robot.camera.rate_hz * steps_per_frame_)),
      motors_(robot.differential()),
      limiter_(commandable(robot.limits), world_.step_s(), robot.wheels()),
      meter_(world_.step_s()),
      state_(world_.state()),
      reflex_m_per_s_(robot.limits.max_velocity_m_per_s) {
  if (!reflex) return;
  if (!robot.equipment || !robot.equipment->reflex)
    throw InputError(
        fmt::format("robot '{}' has no reflex (its file: equipment.collision_reflex)", robot.name));
  reflex_.emplace(scene, robot_);
}

void CommandedBase::add(MovingObstacle other) {
  world_.add(other);
  others_.push_back(std::move(other));
}

void CommandedBase::set_time(double time_s) {
  steps_ = std::lround(time_s / world_.step_s());
  world_.show_at(time_s);
}

void CommandedBase::step(const Twist2d& command) {
  Twist2d twist = command;
  if (robot_.differential() != nullptr) twist.y() = 0;
  const double limit = robot_.limits.max_velocity_m_per_s;
  if (twist.head<2>().norm() > limit) twist.head<2>() *= limit / twist.head<2>().norm();
  twist.z() =
      std::clamp(twist.z(), -robot_.limits.max_turn_rad_per_s, robot_.limits.max_turn_rad_per_s);
  Eigen::Vector2d wanted = turned(twist.head<2>(), state_.heading_rad);
  if (reflex_ && wanted.norm() > 0) {
    if (steps_ % steps_per_frame_ == 0) {
      std::vector<std::pair<Eigen::Vector2d, double>> near;
      for (const MovingObstacle& other : others_)
        near.emplace_back(other.path(time_s()), other.radius_m);
      reflex_m_per_s_ = reflex_->allowed_m_per_s(state_.position_m, wanted.normalized(), near);
    }
    if (wanted.norm() > reflex_m_per_s_) {
      wanted *= reflex_m_per_s_ / wanted.norm();
      reflex_time_s_ += world_.step_s();
    }
  }
  const JerkLimiter::Velocity next =
      limiter_.step(motors_.commanded(wanted, twist.z(), state_.heading_rad));
  const BaseState before = state_;
  const bool touched = contact_.touching;
  const BaseCommand driven = motors_.over_floor(next, state_.heading_rad, world_.step_s());
  contact_ = world_.step(driven);
  state_ = world_.state();
  ++steps_;

  if (contact_.touching &&
      (state_.velocity_m_per_s - driven.velocity_m_per_s).norm() > kPushed_m_per_s) {
    limiter_.stopped_at(motors_.measured(state_));
    meter_.pushed(state_);
  } else {
    meter_.add(state_, robot_.wheels());
  }
  if (contact_.touching && !touched)
    bumps_.push_back(
        {time_s(),
         std::clamp(before.velocity_m_per_s.dot(contact_.direction), 0.0, driven_m_per_s_),
         contact_.instance});
  // After a push, the limiter brakes from a speed that the wheels did not cause: the driven speed
  // is at most the larger of the previous driven speed and the commanded speed.
  driven_m_per_s_ = std::min(next.m_per_s.norm(), std::max(driven_m_per_s_, wanted.norm()));
  length_m_ += (state_.position_m - before.position_m).norm();
  max_penetration_m_ = std::max(max_penetration_m_, contact_.penetration_m);
  if (contact_.touching) contact_time_s_ += world_.step_s();
}

void CommandedBase::carry_to(const Eigen::Vector2d& place_m, double heading_rad) {
  world_.place(place_m, heading_rad);
  state_ = world_.state();
  contact_ = {};
  driven_m_per_s_ = 0;
  limiter_.stopped_at(motors_.measured(state_));
  meter_.pushed(state_);
}

SE3 CommandedBase::world_from_base() const {
  return {Eigen::AngleAxisd(state_.heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
          {state_.position_m.x(), state_.position_m.y(), 0.0}};
}

}  // namespace mh
