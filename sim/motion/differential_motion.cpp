// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/differential_motion.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "robots/model/wheel_base.hpp"
#include "sim/motion/path.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRounding_rad = 1e-9;  // smaller turns are only rounding errors
// Tangential and lateral acceleration share one limit (0.7^2 + 0.7^2 < 1), and smoothing the path
// adds to both.
constexpr double kShare = 0.7;
constexpr double kRimShare = 0.98;  // the rest is left to the controller
constexpr double kMargin = 1.005;   // extra slowdown per round, so that few rounds suffice
constexpr int kRounds = 20;

double shortest_rad(double angle_rad) {
  return std::remainder(angle_rad, 2 * M_PI);
}
double direction_rad(const Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

/// Lateral distance of the outermost wheel from the middle.
double reach_m(const WheelBase& wheels) {
  return rim_speeds_m_per_s(wheels, twist_of(wheels, 0, 1)).cwiseAbs().maxCoeff();
}

/// The factor by which a stretch must be slowed down to keep the limits; a factor of at most 1
/// means no change.
double slowness(const Stretch& stretch, const BaseLimits& limits, const WheelBase& wheels,
                double step_s) {
  const auto n = static_cast<long>(stretch.position_m.size());
  const auto pose = [&](long i) {
    const auto k = static_cast<std::size_t>(std::clamp(i, 0L, n - 1));
    return Vector3d(stretch.position_m[k].x(), stretch.position_m[k].y(), stretch.heading_rad[k]);
  };
  double slow = 0;
  const auto raise = [&](double value, double limit, int order) {
    slow = std::max(slow, std::pow(value / limit, 1.0 / order));
  };
  Vector3d v_before = Vector3d::Zero(), a_before = Vector3d::Zero();
  for (long i = 0; i < n + 2; ++i) {
    const Vector3d v = (pose(i + 1) - pose(i)) / step_s, a = (v - v_before) / step_s,
                   j = (a - a_before) / step_s;
    raise(v.head<2>().norm(), limits.max_velocity_m_per_s, 1);
    raise(std::abs(v.z()), limits.max_turn_rad_per_s, 1);
    raise(v.head<2>().norm() + reach_m(wheels) * std::abs(v.z()),
          kRimShare * wheels.max_rim_m_per_s, 1);
    raise(a.head<2>().norm(), limits.max_acceleration_m_per_s2, 2);
    raise(std::abs(a.z()), limits.max_turn_acceleration_rad_per_s2, 2);
    if (limits.max_jerk_m_per_s3) raise(j.head<2>().norm(), *limits.max_jerk_m_per_s3, 3);
    if (limits.max_turn_jerk_rad_per_s3)
      raise(std::abs(j.z()), *limits.max_turn_jerk_rad_per_s3, 3);
    v_before = v;
    a_before = a;
  }
  return slow;
}

class DifferentialPlanner {
 public:
  DifferentialPlanner(const Tour& tour, const BaseLimits& limits, double step_s,
                      const WheelBase& wheels)
      : tour_(tour),
        limits_(limits),
        planned_(planned_limits(limits)),
        step_s_(step_s),
        wheels_(wheels),
        heading_rad_(tour.start_heading_rad) {
    middle_m_ = tour.start_m + Eigen::Rotation2Dd(heading_rad_) * wheels.middle_m;
    tour_.start_m = middle_m_;
  }

  std::vector<Stretch> plan() {
    for (const TourRun& run : runs_of(tour_, true)) {
      const Waypoint& stop = tour_.waypoints[run.last];
      if ((run.corners_m[1] - run.corners_m[0]).norm() > kNoWay_m) follow(run);
      if (stop.heading_rad) turn(shortest_rad(*stop.heading_rad - heading_rad_), run.last);
      if (stop.turn_rad != 0) turn(stop.turn_rad, run.last);
      if (stop.pause_s > 0) rest(stop.pause_s, run.last);
    }
    return std::move(stretches_);
  }

 private:
  using PoseAt = std::function<Vector3d(double)>;  ///< middle and heading
  using WaypointAt = std::function<std::size_t(double)>;

  void follow(const TourRun& run) {
    const RoundedPath path(run.corners_m, {.eased = true});
    turn(shortest_rad(direction_rad(path.at(0).direction) - heading_rad_), run.first);
    const double along = kShare * planned_.max_acceleration_m_per_s2;
    const SpeedProfile profile(
        path, {.velocity_m_per_s =
                   std::min(planned_.max_velocity_m_per_s, kRimShare * wheels_.max_rim_m_per_s),
               .along_m_per_s2 = along,
               .across_m_per_s2 = along,
               .through = [&](const RoundedPath::Bend& bend) { return fastest_through(bend); }});
    const auto waypoint = [&](double s_m) {
      std::size_t leg = 0;
      while (s_m > path.corner_s_m(leg + 1) && path.corner_s_m(leg + 1) < path.length_m()) ++leg;
      return run.first + leg;
    };
    double heading_rad = heading_rad_;
    const auto pose = [&](double s_m) {
      const PathPoint point = path.at(std::clamp(s_m, 0.0, path.length_m()));
      heading_rad += shortest_rad(direction_rad(point.direction) - heading_rad);
      return Vector3d(point.position_m.x(), point.position_m.y(), heading_rad);
    };
    const auto way_at = [&](double slow) {
      std::vector<double> way;
      const auto steps = static_cast<long>(std::ceil(slow * profile.duration_s() / step_s_));
      for (long i = 1; i <= steps; ++i)
        way.push_back(profile.s_at(static_cast<double>(i) * step_s_ / slow));
      return way;
    };
    add(
        way_at, limits_.max_jerk_m_per_s3,
        [&](double s_m) {
          if (s_m <= 0) heading_rad = heading_rad_;
          return pose(s_m);
        },
        waypoint);
  }

  /// The highest constant speed through a bend; at constant speed, the bend's curvature alone
  /// determines how the base turns.
  double fastest_through(const RoundedPath::Bend& bend) const {
    double most = std::min(
        planned_.max_turn_rad_per_s / bend.curvature_per_m,
        std::sqrt(kShare * planned_.max_turn_acceleration_rad_per_s2 / bend.change_per_m2));
    most = std::min(
        most, kRimShare * wheels_.max_rim_m_per_s / (1 + reach_m(wheels_) * bend.curvature_per_m));
    if (planned_.max_turn_jerk_rad_per_s3)
      most = std::min(
          most, std::cbrt(kShare * *planned_.max_turn_jerk_rad_per_s3 / bend.second_change_per_m3));
    return most;
  }

  void turn(double angle_rad, std::size_t waypoint) {
    if (std::abs(angle_rad) <= kRounding_rad) return;
    const auto turned_at = [&](double slow) {
      BaseLimits slower = planned_;
      slower.max_turn_rad_per_s /= slow;
      slower.max_turn_acceleration_rad_per_s2 /= slow * slow;
      std::vector<double> turned = turn_profile(angle_rad, slower, step_s_);
      turned.back() = angle_rad;
      return turned;
    };
    add(
        turned_at, limits_.max_turn_jerk_rad_per_s3,
        [&](double turned_rad) {
          return Vector3d(middle_m_.x(), middle_m_.y(), heading_rad_ + turned_rad);
        },
        [&](double) { return waypoint; });
  }

  void rest(double pause_s, std::size_t waypoint) {
    add(
        [&](double) {
          return std::vector<double>(static_cast<std::size_t>(std::lround(pause_s / step_s_)), 0.0);
        },
        std::nullopt, [&](double) { return Vector3d(middle_m_.x(), middle_m_.y(), heading_rad_); },
        [&](double) { return waypoint; });
  }

  /// Adds a stretch along one coordinate (distance or angle) that begins at rest at 0, smoothed to
  /// limit its jerk, and driven as slowly as the limits require.
  /// @param profile_at the coordinate over time when driven more slowly by the given factor
  void add(const std::function<std::vector<double>(double)>& profile_at,
           const std::optional<double>& jerk, const PoseAt& pose_at,
           const WaypointAt& waypoint_at) {
    Stretch stretch;
    double slow = 1;
    for (int round = 0; round < kRounds; ++round) {
      Stretch coordinate;  // as a straight line, which smoothed() keeps within the jerk limit
      for (int i = 0; i < 3; ++i) coordinate.position_m.emplace_back(0, 0);
      for (const double value : profile_at(slow)) coordinate.position_m.emplace_back(value, 0);
      coordinate.heading_rad.assign(coordinate.position_m.size(), 0);
      coordinate.waypoint.assign(coordinate.position_m.size(), 0);
      stretch = {};
      const Stretch smooth = smoothed(coordinate, {.max_jerk_m_per_s3 = jerk}, step_s_);
      for (const Vector2d& at : smooth.position_m) {
        const Vector3d pose = pose_at(at.x());
        stretch.heading_rad.push_back(pose.z());
        stretch.position_m.push_back(pose.head<2>() -
                                     Eigen::Rotation2Dd(pose.z()) * wheels_.middle_m);
        stretch.waypoint.push_back(waypoint_at(at.x()));
      }
      const double wanted = slowness(stretch, limits_, wheels_, step_s_);
      if (wanted <= 1) break;
      slow *= kMargin * wanted;
    }
    heading_rad_ = stretch.heading_rad.back();
    middle_m_ = stretch.position_m.back() + Eigen::Rotation2Dd(heading_rad_) * wheels_.middle_m;
    stretches_.push_back(std::move(stretch));
  }

  Tour tour_;  ///< starts at the base's middle
  BaseLimits limits_, planned_;
  double step_s_;
  const WheelBase& wheels_;
  Vector2d middle_m_;
  double heading_rad_;
  std::vector<Stretch> stretches_;
};

}  // namespace

std::vector<Stretch> differential_motion(const Tour& tour, const BaseLimits& limits, double step_s,
                                         const WheelBase& wheels) {
  return DifferentialPlanner(tour, limits, step_s, wheels).plan();
}

}  // namespace mh
