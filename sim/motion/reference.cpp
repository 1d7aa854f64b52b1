// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/reference.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "sim/motion/differential_motion.hpp"
#include "sim/motion/path.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr double kSharpTurn_rad = 2.1;  // beyond 120 degrees a corner is a stop, not an arc
constexpr double kLookAhead_m = 0.7;    // while driving, the robot faces the path this far ahead
constexpr double kFaceFirst_rad = 0.8;  // if its heading is farther off its path, it turns first
constexpr double kHeadingGain_per_s = 3.0;
constexpr double kNoTurn_rad = 0.005;  // a smaller turn is skipped
// Shares of the limits: the rest is left to the controller that keeps the base on its reference,
// and to the physics' single precision.
constexpr double kVelocityShare = 0.999, kAccelerationShare = 0.99, kJerkShare = 0.95;

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * M_PI);
}

double heading_of(const Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

double size_of(double value) {
  return std::abs(value);
}
double size_of(const Vector2d& value) {
  return value.norm();
}

/// Samples one step apart, at rest before the first and after the last.
template <class T>
class Samples {
 public:
  explicit Samples(const std::vector<T>& values) : values_(values) {}
  const T& operator[](long i) const {
    return values_[static_cast<std::size_t>(
        std::clamp(i, 0L, static_cast<long>(values_.size()) - 1))];
  }

  /// Length (steps) of the shortest moving average that keeps the jerk limit.
  long window(double jerk, double step_s) const {
    const long n = static_cast<long>(values_.size());
    std::vector<T> acceleration;  // acceleration is 0 beyond the ends
    for (long i = 0; i < n; ++i)
      acceleration.push_back(((*this)[i + 1] - (*this)[i] - ((*this)[i] - (*this)[i - 1])) /
                             (step_s * step_s));
    const T none = acceleration.front() - acceleration.front();
    const auto at = [&](long i) {
      return i < 0 || i >= n ? none : acceleration[static_cast<std::size_t>(i)];
    };
    const auto keeps = [&](long steps) {
      const double most = jerk * static_cast<double>(steps) * step_s;
      for (long i = 0; i < n + steps; ++i)
        if (size_of(T(at(i) - at(i - steps))) > most) return false;
      return true;
    };
    long steps = 1;
    while (!keeps(steps)) ++steps;  // ends by 2 max|a| / (jerk * step)
    return steps;
  }

  /// `count` means of `steps` samples each, delayed by `delay` steps.
  std::vector<T> averaged(long steps, long delay, long count) const {
    std::vector<T> result;
    for (long k = 0; k < count; ++k) {
      T sum = (*this)[k - delay];
      for (long i = 1; i < steps; ++i) sum += (*this)[k - delay - i];
      result.push_back(sum / static_cast<double>(steps));
    }
    return result;
  }

 private:
  const std::vector<T>& values_;
};

/// The turn rate that brings a heading error to zero without overshoot: proportional near the goal;
/// farther away, the rate at which 80 % of the allowed deceleration just suffices to stop.
double turn_rate(double error_rad, const BaseLimits& limits) {
  const double brake = 0.8 * limits.max_turn_acceleration_rad_per_s2, k = kHeadingGain_per_s;
  const double near_rad = brake / (k * k), size = std::abs(error_rad);
  const double rate = size <= near_rad ? k * size : std::sqrt(2 * brake * (size - 0.5 * near_rad));
  return std::copysign(std::min(rate, limits.max_turn_rad_per_s), error_rad);
}

/// The robot stops at the end, to turn, to pause, and where the path reverses.
bool stops_at(const Tour& tour, std::size_t i, bool turns_at_stops) {
  const Waypoint& here = tour.waypoints[i];
  if (i + 1 == tour.waypoints.size() || here.turn_rad != 0 || here.pause_s > 0) return true;
  if (turns_at_stops && here.heading_rad) return true;
  const Vector2d before = i == 0 ? tour.start_m : tour.waypoints[i - 1].position_m;
  const Vector2d in = here.position_m - before;
  const Vector2d out = tour.waypoints[i + 1].position_m - here.position_m;
  if (in.norm() <= kNoWay_m || out.norm() <= kNoWay_m) return true;
  return std::abs(wrapped(heading_of(out) - heading_of(in))) > kSharpTurn_rad;
}

/// Simulates a tour and records how a base without inertia, limited in velocity and acceleration,
/// would move.
class Planner {
 public:
  Planner(const Tour& tour, const BaseLimits& limits, double step_s)
      : tour_(tour),
        limits_(planned_limits(limits)),
        step_s_(step_s),
        position_m_(tour.start_m),
        heading_rad_(tour.start_heading_rad) {}

  std::vector<Stretch> plan() {
    for (const TourRun& part : runs_of(tour_, false)) run(part);
    return std::move(stretches_);
  }

 private:
  /// Drives through the waypoints; stops at the last and turns or pauses there.
  void run(const TourRun& part) {
    const auto& [first, last, corners] = part;
    const Waypoint& stop = tour_.waypoints[last];
    if ((corners[1] - corners[0]).norm() > kNoWay_m) follow(RoundedPath(corners), first);
    if (stop.heading_rad) turn(wrapped(*stop.heading_rad - heading_rad_), last);
    if (stop.turn_rad != 0) turn(stop.turn_rad, last);
    if (stop.pause_s > 0) {
      begin(last);
      for (long i = std::lround(stop.pause_s / step_s_); i > 0; --i) note(last);
    }
  }

  void begin(std::size_t waypoint) {
    stretches_.emplace_back();
    // Rests for long enough that differences of poses do not reach into the previous stretch.
    for (int i = 0; i < 3; ++i) note(waypoint);
  }
  void note(std::size_t waypoint) {
    Stretch& stretch = stretches_.back();
    stretch.position_m.push_back(position_m_);
    stretch.heading_rad.push_back(heading_rad_);
    stretch.waypoint.push_back(waypoint);
  }

  void follow(const RoundedPath& path, std::size_t first) {
    // Tangential and centripetal acceleration share one limit: 0.7^2 + 0.7^2 < 1.
    const double share = 0.7 * limits_.max_acceleration_m_per_s2;
    const SpeedProfile profile(path, {limits_.max_velocity_m_per_s, share, share});
    const Waypoint& toward = tour_.waypoints[first];
    if (!toward.heading_rad && !toward.look_at_m) {
      // A robot that should face the direction of travel does not start driving sideways.
      const double error_rad = heading_error(toward, path, 0, heading_rad_, 0);
      if (std::abs(error_rad) > kFaceFirst_rad) turn(error_rad, first);
    }

    begin(first);
    std::size_t leg = 0;
    double leg_heading_rad = heading_rad_, turn_rad_per_s = 0;
    const double turn_change = limits_.max_turn_acceleration_rad_per_s2 * step_s_;
    const auto turn_on = [&](double rate) {
      turn_rad_per_s += std::clamp(rate - turn_rad_per_s, -turn_change, turn_change);
      heading_rad_ += turn_rad_per_s * step_s_;
      note(first + leg);
    };
    const auto steps = static_cast<long>(std::ceil(profile.duration_s() / step_s_));
    for (long i = 1; i <= steps; ++i) {
      const double s_m = profile.s_at(static_cast<double>(i) * step_s_);
      while (s_m > path.corner_s_m(leg + 1) && path.corner_s_m(leg + 1) < path.length_m()) {
        ++leg;
        leg_heading_rad = heading_rad_;
      }
      position_m_ = path.at(s_m).position_m;
      const double along =
          (s_m - path.corner_s_m(leg)) / (path.corner_s_m(leg + 1) - path.corner_s_m(leg));
      turn_on(turn_rate(heading_error(tour_.waypoints[first + leg], path, s_m, leg_heading_rad,
                                      std::clamp(along, 0.0, 1.0)),
                        limits_));
    }
    while (turn_rad_per_s != 0) turn_on(0);
  }

  /// Heading error on the leg to a waypoint.
  /// @param along share of the leg that has been driven
  double heading_error(const Waypoint& to, const RoundedPath& path, double s_m,
                       double leg_heading_rad, double along) const {
    if (to.heading_rad) {
      const double blend = along * along * (3 - 2 * along);
      return wrapped(leg_heading_rad + blend * wrapped(*to.heading_rad - leg_heading_rad) -
                     heading_rad_);
    }
    const Vector2d goal = to.look_at_m ? *to.look_at_m : path.at(s_m + kLookAhead_m).position_m;
    return wrapped(heading_of(goal - position_m_) - heading_rad_);
  }

  void turn(double angle_rad, std::size_t waypoint) {
    const double start_rad = heading_rad_;
    if (std::abs(angle_rad) <= kNoTurn_rad) return;
    begin(waypoint);
    for (const double turned_rad : turn_profile(angle_rad, limits_, step_s_)) {
      heading_rad_ = start_rad + turned_rad;
      note(waypoint);
    }
  }

  const Tour& tour_;
  BaseLimits limits_;
  double step_s_;
  Vector2d position_m_;
  double heading_rad_;
  std::vector<Stretch> stretches_;
};

}  // namespace

Stretch smoothed(const Stretch& stretch, const BaseLimits& limits, double step_s) {
  assert(!stretch.position_m.empty());
  const Samples position(stretch.position_m);
  const Samples heading(stretch.heading_rad);
  const auto window = [&](const auto& samples, const std::optional<double>& jerk) {
    return jerk ? samples.window(kJerkShare * *jerk, step_s) : 1L;
  };
  const long way = window(position, limits.max_jerk_m_per_s3);
  const long turn = window(heading, limits.max_turn_jerk_rad_per_s3);
  const long both = std::max(way, turn);
  const long count = static_cast<long>(stretch.position_m.size()) + both - 1;
  Stretch result{.position_m = position.averaged(way, (both - way) / 2, count),
                 .heading_rad = heading.averaged(turn, (both - turn) / 2, count),
                 .waypoint = {}};
  const Samples waypoint(stretch.waypoint);
  for (long k = 0; k < count; ++k) result.waypoint.push_back(waypoint[k - both / 2]);
  return result;
}

std::vector<TourRun> runs_of(const Tour& tour, bool turns_at_stops) {
  std::vector<TourRun> runs;
  std::size_t first = 0;
  for (std::size_t i = 0; i < tour.waypoints.size(); ++i) {
    if (!stops_at(tour, i, turns_at_stops)) continue;
    TourRun run{.first = first,
                .last = i,
                .corners_m = {first == 0 ? tour.start_m : tour.waypoints[first - 1].position_m}};
    for (; first <= i; ++first) run.corners_m.push_back(tour.waypoints[first].position_m);
    runs.push_back(std::move(run));
  }
  return runs;
}

BaseLimits planned_limits(BaseLimits limits) {
  limits.max_velocity_m_per_s *= kVelocityShare;
  limits.max_turn_rad_per_s *= kVelocityShare;
  limits.max_acceleration_m_per_s2 *= kAccelerationShare;
  limits.max_turn_acceleration_rad_per_s2 *= kAccelerationShare;
  return limits;
}

std::vector<double> turn_profile(double angle_rad, const BaseLimits& limits, double step_s) {
  const double size = std::abs(angle_rad);
  const double a = limits.max_turn_acceleration_rad_per_s2;
  const double top = std::min(limits.max_turn_rad_per_s, std::sqrt(size * a));
  const double ramp_s = top / a, duration_s = size / top + ramp_s;
  std::vector<double> angles;
  for (double t = step_s; t < duration_s + step_s; t += step_s) {
    const double left_s = std::max(0.0, duration_s - t);
    const double turned = t < ramp_s        ? 0.5 * a * t * t
                          : left_s < ramp_s ? size - 0.5 * a * left_s * left_s
                                            : top * (t - 0.5 * ramp_s);
    angles.push_back(std::copysign(turned, angle_rad));
  }
  return angles;
}

std::vector<Stretch> reference_motion(const Tour& tour, const BaseLimits& limits, double step_s,
                                      const WheelBase* differential) {
  assert(!tour.waypoints.empty());
  if (differential != nullptr) return differential_motion(tour, limits, step_s, *differential);
  std::vector<Stretch> stretches = Planner(tour, limits, step_s).plan();
  for (Stretch& stretch : stretches) stretch = smoothed(stretch, limits, step_s);
  return stretches;
}

}  // namespace mh
