// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/reflex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mh {
namespace {

using Eigen::Vector2d;

// Less than the base is capable of: the jerk limit delays braking.
constexpr double kBraking = 0.5;
constexpr double kFade_per_s = 2.0;
constexpr double kNever_m = std::numeric_limits<double>::infinity();

/// How far the base can move until its shell reaches the point.
double way_to_point_m(const Vector2d& p, double radius_m) {
  return p.x() - std::sqrt(std::max(0.0, radius_m * radius_m - p.y() * p.y()));
}

}  // namespace

Reflex::Reflex(const Scene& scene, const Robot& robot)
    : outline_(floor_outline(scene, static_cast<float>(scene.floor.rough_m),
                             static_cast<float>(robot.height_m))),
      radius_m_(robot.footprint_radius_m),
      zone_(*robot.equipment->reflex),
      brake_m_per_s2_(kBraking * robot.limits.max_acceleration_m_per_s2),
      // The distance at which the robot has to slow down from its top speed.
      reach_m_(radius_m_ + zone_.aside_m + zone_.ahead_m + soft_m() +
               robot.limits.max_velocity_m_per_s * robot.limits.max_velocity_m_per_s /
                   (2 * brake_m_per_s2_)) {}

double Reflex::allowed_m_per_s(const Vector2d& place_m, const Vector2d& direction,
                               const std::vector<std::pair<Vector2d, double>>& others) const {
  const auto ahead_and_aside = [&](const Vector2d& p) {
    const Vector2d away = p - place_m;
    return Vector2d(direction.dot(away), direction.x() * away.y() - direction.y() * away.x());
  };
  double free_m = reach_m_;  // from the shell to the nearest thing ahead
  for (const OutlineEdge& edge : outline_) {
    const Vector2d a = edge.a_m.cast<double>(), b = edge.b_m.cast<double>();
    const Vector2d low = a.cwiseMin(b) - place_m, high = a.cwiseMax(b) - place_m;
    if (low.maxCoeff() > reach_m_ || high.minCoeff() < -reach_m_) continue;
    free_m = std::min(free_m, way_to_edge_m(ahead_and_aside(a), ahead_and_aside(b)));
  }
  for (const auto& [p, size_m] : others)
    free_m = std::min(free_m, way_to_disc_m(ahead_and_aside(p), size_m));
  const double left_m = std::max(0.0, free_m - zone_.ahead_m);
  // Braking at a constant rate would end with a jerk, so its end is faded out.
  if (left_m < soft_m()) return kFade_per_s * left_m;
  return std::sqrt(2 * brake_m_per_s2_ * (left_m - 0.5 * soft_m()));
}

/// Length of the last stretch, on which the speed is kFade_per_s times the remaining distance;
/// where it begins, this rule brakes as hard as braking at a constant rate.
double Reflex::soft_m() const {
  return brake_m_per_s2_ / (kFade_per_s * kFade_per_s);
}

double Reflex::way_to_disc_m(const Vector2d& middle, double size_m) const {
  const double reach_m = radius_m_ + size_m;
  if (middle.x() <= 0 || std::abs(middle.y()) >= reach_m + zone_.aside_m) return kNever_m;
  return way_to_point_m(middle, reach_m);
}

/// The smallest way_to_point_m() on the part of the edge from a to b that is ahead of the base's
/// center and not too far to the side. Coordinates are meters ahead and to the left of that center.
double Reflex::way_to_edge_m(const Vector2d& a, const Vector2d& b) const {
  const Vector2d d = b - a;
  double from = 0, to = 1;
  const auto keep_positive = [&](double at_a, double change) {
    if (change == 0 && at_a <= 0) to = -1;
    if (change > 0) from = std::max(from, -at_a / change);
    if (change < 0) to = std::min(to, -at_a / change);
  };
  const double half_m = radius_m_ + zone_.aside_m;
  keep_positive(a.x(), d.x());
  keep_positive(half_m - a.y(), -d.y());
  keep_positive(half_m + a.y(), d.y());
  if (from >= to) return kNever_m;
  const auto way_m = [&](double t) {
    return way_to_point_m(a + std::clamp(t, from, to) * d, radius_m_);
  };
  double nearest_m = std::min(way_m(from), way_m(to));
  if (d.y() == 0) return nearest_m;
  // Where the edge leaves the shell's width, and where it is tangent to the shell.
  const double slant = d.x() / d.y();
  for (const double aside_m :
       {-radius_m_, radius_m_, -radius_m_ * slant / std::sqrt(1 + slant * slant)})
    nearest_m = std::min(nearest_m, way_m((aside_m - a.y()) / d.y()));
  return nearest_m;
}

}  // namespace mh
