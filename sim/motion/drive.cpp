// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "sim/motion/automatic.hpp"
#include "sim/motion/motion.hpp"
#include "sim/motion/path.hpp"
#include "sim/motion/start.hpp"
#include "sim/physics/planar_world.hpp"
#include "slam/core/error.hpp"

namespace mh {
namespace {

constexpr double kStepRate_hz = 240.0;  // physics steps per second, at least
constexpr double kSharpTurn_rad = 2.1;  // beyond 120 degrees a corner is a stop, not a bow
constexpr double kLookAhead_m = 0.7;    // a traveller faces this far ahead
constexpr double kFaceFirst_rad = 0.8;  // more than this off the way: turn before driving
constexpr double kPositionGain_per_s = 2.0;
constexpr double kHeadingGain_per_s = 3.0;
constexpr double kStuck_m = 0.15;  // this far behind the plan, something is in the way
constexpr double kArrived_m = 0.01, kTurned_rad = 0.005;
constexpr double kAtRest_m_per_s = 0.01;
constexpr double kPatience_s = 3.0;  // for the last centimetre of an arrival

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * M_PI);
}

double heading_of(const Eigen::Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

/// The turn rate that brings a heading error to zero without overshoot: proportional near the
/// goal, and farther off the rate from which 80 % of the allowed deceleration just suffices.
double turn_rate(double error_rad, const BaseLimits& limits) {
  const double brake = 0.8 * limits.max_turn_acceleration_rad_per_s2, k = kHeadingGain_per_s;
  const double near_rad = brake / (k * k), size = std::abs(error_rad);
  const double rate = size <= near_rad ? k * size : std::sqrt(2 * brake * (size - 0.5 * near_rad));
  return std::copysign(std::min(rate, limits.max_turn_rad_per_s), error_rad);
}

/// A robot on its tour: steps the physics, keeps the record.
class Driver {
 public:
  Driver(const Scene& scene, const Robot& robot, const Tour& tour)
      : scene_(scene),
        robot_(robot),
        tour_(tour),
        steps_per_frame_(static_cast<int>(std::ceil(kStepRate_hz / robot.camera.rate_hz))),
        world_(scene, robot, tour.start_m, tour.start_heading_rad,
               1.0 / (robot.camera.rate_hz * steps_per_frame_)),
        state_(world_.state()),
        heading_rad_(tour.start_heading_rad) {
    check_start(world_, scene, tour.start_m, tour.file.string());
    record();
  }

  /// Drives through waypoints [first, last]; stops at the last, acts there.
  void run(std::size_t first, std::size_t last) {
    const Waypoint& stop = tour_.waypoints[last];
    std::vector<Eigen::Vector2d> corners{place_before(first)};
    for (std::size_t i = first; i <= last; ++i) corners.push_back(tour_.waypoints[i].position_m);
    if ((corners[1] - corners[0]).norm() > kArrived_m) follow(RoundedPath(corners), first);
    if (stop.heading_rad) turn(wrapped(*stop.heading_rad - heading_rad_), last);
    if (stop.turn_rad != 0) turn(stop.turn_rad, last);
    const auto pause = static_cast<long>(std::lround(stop.pause_s / world_.step_s()));
    for (long i = 0; i < pause; ++i) hold(stop.position_m, heading_rad_);
  }

  /// Rests until the next frame is due, and hands the record over.
  DrivenPath finish() {
    while (steps_ % steps_per_frame_ != 0) hold(tour_.waypoints.back().position_m, heading_rad_);
    return std::move(path_);
  }

 private:
  [[noreturn]] void fail(std::size_t index, const Eigen::Vector2d& goal_m) {
    const Waypoint& w = tour_.waypoints[index];
    const std::string line = w.line > 0 ? fmt::format(":{}", w.line) : "";
    throw InputError(
        fmt::format("{}{}: waypoint {}: [{:.2f}, {:.2f}] cannot be reached: the robot is stuck at "
                    "[{:.2f}, {:.2f}] m{}, on its way to [{:.2f}, {:.2f}]",
                    tour_.file.string(), line, index + 1, w.position_m.x(), w.position_m.y(),
                    state_.position_m.x(), state_.position_m.y(), against(scene_, last_touched_),
                    goal_m.x(), goal_m.y()));
  }

  Eigen::Vector2d place_before(std::size_t index) const {
    return index == 0 ? tour_.start_m : tour_.waypoints[index - 1].position_m;
  }

  void follow(const RoundedPath& path, std::size_t first) {
    // Speeding up along the path and turning with it share one acceleration: 0.7^2 + 0.7^2 < 1.
    const BaseLimits& limits = robot_.limits;
    const double share = 0.7 * limits.max_acceleration_m_per_s2;
    const SpeedProfile profile(path, {limits.max_velocity_m_per_s, share, share});
    face_first(path, first);

    std::size_t leg = 0;
    double leg_heading_rad = heading_rad_, s_m = 0, v_m_per_s = 0;
    while (path.length_m() - s_m > 1e-3) {
      v_m_per_s = std::min(v_m_per_s + share * world_.step_s(), profile.at(s_m));
      s_m += v_m_per_s * world_.step_s();
      while (s_m > path.corner_s_m(leg + 1) && path.corner_s_m(leg + 1) < path.length_m()) {
        ++leg;
        leg_heading_rad = heading_rad_;
      }
      const PathPoint now = path.at(s_m);
      const Eigen::Vector2d behind_m = now.position_m - state_.position_m;
      if (behind_m.norm() > kStuck_m) fail(first + leg, now.position_m);
      const double along =
          (s_m - path.corner_s_m(leg)) / (path.corner_s_m(leg + 1) - path.corner_s_m(leg));
      const double error_rad = heading_error(tour_.waypoints[first + leg], path, s_m,
                                             leg_heading_rad, std::clamp(along, 0.0, 1.0));
      step({v_m_per_s * now.direction + kPositionGain_per_s * behind_m,
            turn_rate(error_rad, limits)});
    }
    arrive(path.at(path.length_m()).position_m, first + leg);
  }

  /// Who means to face the way of travel does not set off sideways.
  void face_first(const RoundedPath& path, std::size_t first) {
    const Waypoint& w = tour_.waypoints[first];
    if (w.heading_rad || w.look_at_m) return;
    const double error_rad = heading_error(w, path, 0, heading_rad_, 0);
    if (std::abs(error_rad) > kFaceFirst_rad) turn(error_rad, first);
  }

  /// How far the heading is from where it should be on the leg to a waypoint.
  /// @param along share of the leg that has been driven
  double heading_error(const Waypoint& to, const RoundedPath& path, double s_m,
                       double leg_heading_rad, double along) const {
    if (to.heading_rad) {
      const double blend = along * along * (3 - 2 * along);
      return wrapped(leg_heading_rad + blend * wrapped(*to.heading_rad - leg_heading_rad) -
                     heading_rad_);
    }
    const Eigen::Vector2d from = state_.position_m;
    const Eigen::Vector2d goal =
        to.look_at_m ? *to.look_at_m : path.at(s_m + kLookAhead_m).position_m;
    return wrapped(heading_of(goal - from) - heading_rad_);
  }

  void arrive(const Eigen::Vector2d& goal_m, std::size_t index) {
    const double give_up_s = time_s() + kPatience_s;
    while ((goal_m - state_.position_m).norm() > kArrived_m ||
           state_.velocity_m_per_s.norm() > kAtRest_m_per_s) {
      if (time_s() > give_up_s) fail(index, goal_m);
      hold(goal_m, heading_rad_);
    }
  }

  void turn(double angle_rad, std::size_t index) {
    const Eigen::Vector2d place_m = state_.position_m;
    const double goal_rad = heading_rad_ + angle_rad;
    const BaseLimits& limits = robot_.limits;
    const double give_up_s =
        time_s() + kPatience_s + std::abs(angle_rad) / limits.max_turn_rad_per_s +
        4 * limits.max_turn_rad_per_s / limits.max_turn_acceleration_rad_per_s2;
    while (std::abs(goal_rad - heading_rad_) > kTurned_rad ||
           std::abs(state_.turn_rad_per_s) > 2 * kTurned_rad) {
      if (time_s() > give_up_s) fail(index, place_m);
      hold(place_m, goal_rad);
    }
  }

  /// One step at rest in a place, turning towards a heading (not wrapped: may be rounds away).
  void hold(const Eigen::Vector2d& place_m, double heading_rad) {
    step({kPositionGain_per_s * (place_m - state_.position_m),
          turn_rate(heading_rad - heading_rad_, robot_.limits)});
  }

  void step(const BaseCommand& command) {
    const BaseState before = state_;
    const Contact contact = world_.step(command);
    state_ = world_.state();
    ++steps_;

    const double turned_rad = wrapped(state_.heading_rad - before.heading_rad);
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
  double heading_rad_;  // as state_.heading_rad, but counting whole rounds
  long steps_ = 0;
  InstanceId last_touched_ = 0;
  DrivenPath path_;
};

/// The robot stops at the end, to turn, to pause, and where the way turns back on itself.
bool stops_at(const Tour& tour, std::size_t i) {
  const Waypoint& here = tour.waypoints[i];
  if (i + 1 == tour.waypoints.size() || here.turn_rad != 0 || here.pause_s > 0) return true;
  const Eigen::Vector2d before = i == 0 ? tour.start_m : tour.waypoints[i - 1].position_m;
  const Eigen::Vector2d in = here.position_m - before;
  const Eigen::Vector2d out = tour.waypoints[i + 1].position_m - here.position_m;
  if (in.norm() <= kArrived_m || out.norm() <= kArrived_m) return true;
  return std::abs(wrapped(heading_of(out) - heading_of(in))) > kSharpTurn_rad;
}

Robot restrained(Robot robot, const Tour& tour) {
  BaseLimits& limits = robot.limits;
  limits.max_velocity_m_per_s = std::min(
      limits.max_velocity_m_per_s, tour.max_velocity_m_per_s.value_or(limits.max_velocity_m_per_s));
  limits.max_turn_rad_per_s = std::min(limits.max_turn_rad_per_s,
                                       tour.max_turn_rad_per_s.value_or(limits.max_turn_rad_per_s));
  return robot;
}

}  // namespace

DrivenPath drive(const Scene& scene, const Robot& robot, const Tour& tour) {
  if (tour.waypoints.empty())
    throw InputError(fmt::format("{}: the tour has no waypoints", tour.file.string()));
  if (tour.plan) return drive(scene, robot, planned(scene, robot, tour));
  const Robot driven = restrained(robot, tour);
  Driver driver(scene, driven, tour);
  std::size_t first = 0;
  for (std::size_t i = 0; i < tour.waypoints.size(); ++i) {
    if (!stops_at(tour, i)) continue;
    driver.run(first, i);
    first = i + 1;
  }
  return driver.finish();
}

}  // namespace mh
