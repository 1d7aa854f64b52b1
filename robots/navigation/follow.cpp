// SPDX-License-Identifier: Apache-2.0
#include "robots/navigation/follow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr double kSlowest_m_per_s = 0.03;  // anything slower is standing still
constexpr double kTurnGain_per_s = 1.5;
constexpr double kToward = 0.5;  // cosine: motion within 60 degrees of an obstacle is toward it

/// Index of the sample nearest to a place.
std::size_t nearest_sample(const std::vector<Vector2d>& path, const Vector2d& place_m) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    if ((path[i] - place_m).squaredNorm() < (path[best] - place_m).squaredNorm()) best = i;
  return best;
}

}  // namespace

double speed_before(std::span<const Vector2d> obstacles_m, const Vector2d& place_m,
                    const Vector2d& direction, double radius_m, double braking_m_per_s2) {
  double free_m = std::numeric_limits<double>::infinity();
  for (const Vector2d& obstacle : obstacles_m) {
    const Vector2d away = obstacle - place_m;
    const double ahead_m = direction.dot(away);
    const double aside_m = direction.x() * away.y() - direction.y() * away.x();
    if (away.norm() < radius_m) {  // too near already: the robot may move away or pass by
      if (ahead_m > kToward * away.norm()) free_m = 0;
      continue;
    }
    if (ahead_m <= 0 || std::abs(aside_m) >= radius_m) continue;
    free_m = std::min(free_m, ahead_m - std::sqrt(radius_m * radius_m - aside_m * aside_m));
  }
  if (std::isinf(free_m)) return free_m;
  return std::sqrt(2 * braking_m_per_s2 * std::max(0.0, free_m));
}

Twist2d turn_in_place(double left_rad, const BaseLimits& limits, const FollowConfig& config,
                      double close_rad) {
  if (std::abs(left_rad) < close_rad) return Twist2d::Zero();
  const double braking = config.braking * limits.max_turn_acceleration_rad_per_s2;
  const double most =
      std::min({config.turn_rad_per_s, limits.max_turn_rad_per_s,
                std::sqrt(2 * braking * std::abs(left_rad)), kTurnGain_per_s * std::abs(left_rad)});
  return {0, 0, std::copysign(most, left_rad)};
}

Steering follow(const std::vector<Vector2d>& path, const Pose2& at,
                std::span<const Vector2d> obstacles_m, const Robot& robot,
                const FollowConfig& config) {
  Steering steering;
  const std::size_t here = nearest_sample(path, at.place_m);
  std::size_t aim = here;
  double along_m = 0;
  while (aim + 1 < path.size() && along_m < config.ahead_m) {
    along_m += (path[aim + 1] - path[aim]).norm();
    ++aim;
  }
  steering.left_m = (path[here] - at.place_m).norm();
  for (std::size_t i = here; i + 1 < path.size(); ++i)
    steering.left_m += (path[i + 1] - path[i]).norm();
  const Vector2d to_aim = path[aim] - at.place_m;
  if ((path.back() - at.place_m).norm() < config.arrived_m) {
    steering.arrived = true;
    return steering;
  }
  const bool ahead_only = robot.differential() != nullptr;
  const Vector2d direction = ahead_only
                                 ? Pose2{Vector2d::Zero(), at.heading_rad}.turned(Vector2d::UnitX())
                                 : Vector2d(to_aim.normalized());
  const double off_rad = turn_to(at.heading_rad, std::atan2(to_aim.y(), to_aim.x()));
  const double braking = config.braking * robot.limits.max_acceleration_m_per_s2;
  steering.command = turn_in_place(off_rad, robot.limits, config, 0.01);
  // For the last 15 cm, an omnidirectional base drives in any direction instead of turning first.
  const bool faces = std::abs(off_rad) < config.face_rad || (!ahead_only && steering.left_m < 0.15);
  const double radius_m = robot.footprint_radius_m + config.shell_margin_m;
  const double before_m_per_s = speed_before(obstacles_m, at.place_m, direction, radius_m, braking);
  steering.blocked = before_m_per_s < kSlowest_m_per_s;
  if (!faces || steering.blocked) return steering;
  const double speed = std::min(
      {config.speed_m_per_s * std::max(0.2, std::cos(std::min(std::abs(2 * off_rad), M_PI_2))),
       robot.limits.max_velocity_m_per_s,
       std::max(0.05, std::sqrt(2 * braking * std::max(0.0, steering.left_m - 0.02))),
       before_m_per_s});
  steering.command.head<2>() =
      ahead_only ? Vector2d(speed, 0)
                 : Pose2{Vector2d::Zero(), -at.heading_rad}.turned(speed * direction);
  return steering;
}

}  // namespace mh
