// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "robots/model/wheel_base.hpp"
#include "sim/motion/automatic.hpp"
#include "sim/motion/motion.hpp"
#include "sim/motion/motors.hpp"
#include "sim/motion/peaks.hpp"
#include "sim/motion/reference.hpp"
#include "sim/motion/start.hpp"
#include "sim/physics/planar_world.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

// Drift from single precision is corrected gently; a push, firmly.
constexpr double kDriftGain_per_s = 0.2, kPushGain_per_s = 2.0;
constexpr double kDrift_m = 0.005;
// A differential base steers back to its path within about a meter: the lateral error decays over
// distance like a critically damped oscillation, kSteer_per_m per meter.
constexpr double kSteer_per_m = 2.0;
constexpr double kStuck_m = 0.15;  // if this far behind the plan, something is in the way
constexpr double kArrived_m = 0.01, kTurned_rad = 0.005;
constexpr double kAtRest_m_per_s = 0.01;
constexpr double kPatience_s = 3.0;  // how long to wait for an arrival

/// A robot on its tour: steps the physics and records the motion.
class Driver {
 public:
  Driver(const Scene& scene, const Robot& robot, const Tour& tour,
         const std::vector<MovingObstacle>& others)
      : scene_(scene),
        robot_(robot),
        tour_(tour),
        steps_per_frame_(static_cast<int>(std::ceil(kStepRate_hz / robot.camera.rate_hz))),
        world_(scene, robot, tour.start_m, tour.start_heading_rad,
               1.0 / (robot.camera.rate_hz * steps_per_frame_)),
        state_(world_.state()),
        heading_rad_(tour.start_heading_rad),
        motors_(robot.differential()),
        correction_(robot.limits, world_.step_s()),
        meter_(world_.step_s()) {
    for (const MovingObstacle& other : others) world_.add(other);
    check_start(world_, scene, tour.start_m, file_and_line(tour.file, tour.start_line));
    record();
  }

  DrivenPath run() {
    Goal rest{tour_.start_m, tour_.start_heading_rad};
    for (const Stretch& stretch :
         reference_motion(tour_, robot_.limits, world_.step_s(), robot_.differential()))
      rest = follow(stretch);
    while (steps_ % steps_per_frame_ != 0) step(rest, {});
    path_.peaks = meter_.peaks();
    return std::move(path_);
  }

 private:
  struct Goal {
    Eigen::Vector2d position_m;
    double heading_rad;
  };

  [[noreturn]] void fail(std::size_t index, const Eigen::Vector2d& goal_m) {
    const Waypoint& w = tour_.waypoints[index];
    throw InputError(
        fmt::format("{}: waypoint {}: [{:.2f}, {:.2f}] cannot be reached{}: the robot is stuck at "
                    "[{:.2f}, {:.2f}] m{}, on its way to [{:.2f}, {:.2f}]",
                    file_and_line(tour_.file, w.line), index + 1, w.position_m.x(),
                    w.position_m.y(), outside_rooms(scene_, w.position_m), state_.position_m.x(),
                    state_.position_m.y(), against(scene_, last_touched_), goal_m.x(), goal_m.y()));
  }

  /// Drives a stretch, waits until its end is reached, and returns the end as a goal.
  Goal follow(const Stretch& stretch) {
    const auto goal = [&](std::size_t i) {
      return Goal{stretch.position_m[i], stretch.heading_rad[i]};
    };
    const std::size_t last = stretch.position_m.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
      const Goal now = goal(i), next = goal(i + 1);
      if ((now.position_m - state_.position_m).norm() > kStuck_m)
        fail(stretch.waypoint[i], now.position_m);
      step(now, {(next.position_m - now.position_m) / world_.step_s(),
                 (next.heading_rad - now.heading_rad) / world_.step_s()});
    }
    const Goal end = goal(last);
    const double give_up_s = time_s() + kPatience_s;
    while (off_m(end) > kArrived_m || state_.velocity_m_per_s.norm() > kAtRest_m_per_s ||
           std::abs(end.heading_rad - heading_rad_) > kTurned_rad) {
      if (time_s() > give_up_s) fail(stretch.waypoint[last], end.position_m);
      step(end, {});
    }
    return end;
  }

  /// Distance to the goal, counting only what can be corrected without turning.
  double off_m(const Goal& goal) const {
    const Eigen::Vector2d error_m = goal.position_m - state_.position_m;
    return robot_.differential() == nullptr
               ? error_m.norm()
               : std::abs((Eigen::Rotation2Dd(-heading_rad_) * error_m).x());
  }

  /// The motors' velocity for a velocity of the base on its reference.
  JerkLimiter::Velocity plan_of(const Goal& reference, const BaseCommand& velocity) const {
    const double middle_rad =
        reference.heading_rad + 0.5 * velocity.turn_rad_per_s * world_.step_s();
    return motors_.commanded(velocity.velocity_m_per_s, velocity.turn_rad_per_s, middle_rad);
  }

  /// The correction that brings the base back to its reference: directly or, for a differential
  /// base, by driving ahead or back and by steering, as in Kanayama et al., "A stable tracking
  /// control method for an autonomous mobile robot", ICRA 1990.
  JerkLimiter::Velocity toward(const Goal& reference, const JerkLimiter::Velocity& plan) const {
    const double turn_rad = reference.heading_rad - heading_rad_;
    Eigen::Vector2d error_m = reference.position_m - state_.position_m;
    double turn_rad_per_s = kDriftGain_per_s * turn_rad;
    if (robot_.differential() != nullptr) {
      const Eigen::Vector2d in_base = Eigen::Rotation2Dd(-heading_rad_) * error_m;
      const double speed = plan.m_per_s.x();
      turn_rad_per_s += speed * kSteer_per_m * kSteer_per_m * in_base.y() +
                        2 * std::abs(speed) * kSteer_per_m * turn_rad;
      error_m = {in_base.x(), 0};
    }
    const double pushed_m = std::max(0.0, error_m.norm() - kDrift_m);
    return {.m_per_s = kDriftGain_per_s * error_m +
                       kPushGain_per_s * pushed_m * error_m.stableNormalized(),
            .turn_rad_per_s = turn_rad_per_s};
  }

  /// One physics step with the reference's velocity plus a correction toward the reference's
  /// position.
  void step(const Goal& reference, const BaseCommand& velocity) {
    const JerkLimiter::Velocity plan = plan_of(reference, velocity);
    const JerkLimiter::Velocity correction = correction_.step(toward(reference, plan));
    const BaseCommand command =
        motors_.over_floor({.m_per_s = plan.m_per_s + correction.m_per_s,
                            .turn_rad_per_s = plan.turn_rad_per_s + correction.turn_rad_per_s},
                           state_.heading_rad, world_.step_s());
    const BaseState before = state_;
    const Contact contact = world_.step(command);
    state_ = world_.state();
    ++steps_;

    if (contact.touching &&
        (state_.velocity_m_per_s - command.velocity_m_per_s).norm() > kPushed_m_per_s) {
      const JerkLimiter::Velocity now = motors_.measured(state_);
      correction_.stopped_at(
          {now.m_per_s - plan.m_per_s, now.turn_rad_per_s - plan.turn_rad_per_s});
      meter_.pushed(state_);
    } else {
      meter_.add(state_, robot_.wheels());
    }
    const double turned_rad = std::remainder(state_.heading_rad - before.heading_rad, 2 * M_PI);
    heading_rad_ += turned_rad;
    path_.length_m += (state_.position_m - before.position_m).norm();
    if (state_.velocity_m_per_s.norm() < kAtRest_m_per_s)
      path_.turned_in_place_rad += std::abs(turned_rad);
    path_.max_penetration_m = std::max(path_.max_penetration_m, contact.penetration_m);
    if (contact.touching) {
      path_.contact_time_s += world_.step_s();
      last_touched_ = contact.instance;
    }
    if (steps_ % steps_per_frame_ == 0) record();
  }

  void record() {
    const auto frame = static_cast<double>(path_.base.size());
    const Stamp stamp_ns = std::llround(frame * 1e9 / robot_.camera.rate_hz);
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(state_.heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const SE3 world_from_base(rotation, {state_.position_m.x(), state_.position_m.y(), 0.0});
    path_.base.push_back({stamp_ns, world_from_base});
    path_.camera.push_back({stamp_ns, world_from_base * robot_.base_from_camera});
  }

  double time_s() const { return static_cast<double>(steps_) * world_.step_s(); }

  const Scene& scene_;
  const Robot& robot_;
  const Tour& tour_;
  int steps_per_frame_;
  PlanarWorld world_;
  BaseState state_;
  double heading_rad_;  // as state_.heading_rad, but including full turns
  Motors motors_;
  JerkLimiter correction_;  // velocity added to the reference's
  PeakMeter meter_;
  long steps_ = 0;
  InstanceId last_touched_ = 0;
  DrivenPath path_;
};

Robot restrained(Robot robot, const Tour& tour) {
  BaseLimits& limits = robot.limits;
  limits.max_velocity_m_per_s = std::min(
      limits.max_velocity_m_per_s, tour.max_velocity_m_per_s.value_or(limits.max_velocity_m_per_s));
  limits.max_turn_rad_per_s = std::min(limits.max_turn_rad_per_s,
                                       tour.max_turn_rad_per_s.value_or(limits.max_turn_rad_per_s));
  return robot;
}

}  // namespace

DrivenPath drive(const Scene& scene, const Robot& robot, const Tour& tour,
                 const std::vector<MovingObstacle>& others) {
  if (tour.waypoints.empty())
    throw InputError(fmt::format("{}: the tour has no waypoints", tour.file.string()));
  if (tour.plan) return drive(scene, robot, planned(scene, robot, tour), others);
  const Robot driven = restrained(robot, tour);
  return Driver(scene, driven, tour, others).run();
}

}  // namespace mh
