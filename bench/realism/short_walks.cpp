// SPDX-License-Identifier: Apache-2.0
#include "bench/realism/short_walks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "bench/pictures/contact_sheet.hpp"
#include "scenes/dice.hpp"
#include "slam/core/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kClearance_m = 0.3, kFlat_m = 0.03;
constexpr double kRate_hz = 30.0;

/// Distance to the walls from inside, below 0 outside.
double depth_inside(const Room& room, const Vector2d& p) {
  double nearest = 1e30;
  const auto& corners = room.polygon_m;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vector2d &a = corners[j], &b = corners[i];
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - a - t * (b - a)).norm());
  }
  return room.contains(p) ? nearest : -nearest;
}

bool is_free(const Scene& scene, const Vector3d& eye) {
  return std::ranges::none_of(scene.instances, [&](const Instance& instance) {
    const std::string_view name = classes()[instance.class_id].name;
    if (name == "wall" || name == "floor" || name == "ceiling" || name == "otherstructure")
      return false;
    if (instance.max_m.z() <= kFlat_m || instance.min_m.z() > eye.z() + kClearance_m) return false;
    const Eigen::Vector2d low = instance.min_m.head<2>().cast<double>(),
                          high = instance.max_m.head<2>().cast<double>();
    return (eye.head<2>() - eye.head<2>().cwiseMax(low).cwiseMin(high)).norm() < kClearance_m;
  });
}

}  // namespace

std::vector<Trajectory> short_walks(const Scene& scene, std::uint64_t seed, std::size_t count) {
  if (scene.rooms.empty()) throw InputError(fmt::format("scene {}: has no room", scene.name));
  constexpr double kDegree = std::numbers::pi / 180.0;
  Dice dice(RandomStream(seed).fork(0x77616c6b));
  std::vector<Trajectory> walks;
  for (std::size_t tries = 0; walks.size() < count; ++tries) {
    if (tries > 2000 * (count + 1))
      throw InputError(fmt::format("scene {}: no free place for a camera", scene.name));
    const Room& room = scene.rooms[dice.below(scene.rooms.size())];
    Vector2d low = room.polygon_m.front(), high = low;
    for (const Vector2d& p : room.polygon_m) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const double x = dice.number(low.x(), high.x()), y = dice.number(low.y(), high.y());
    const Vector3d eye(x, y, dice.number(1.1, 1.6));
    const double yaw = dice.number(-std::numbers::pi, std::numbers::pi);
    const double pitch = dice.number(-30, 12) * kDegree;
    const double speed = dice.number(0.03, 0.42), course = yaw + dice.number(-0.6, 0.6);
    const double turning = dice.number(2, 26) * kDegree, share = dice.number(-1, 1);
    // Nobody scans a wall from a hand's breadth: a metre ahead there is still room.
    const Vector2d ahead = eye.head<2>() + Vector2d(std::cos(yaw), std::sin(yaw));
    if (depth_inside(room, eye.head<2>()) < kClearance_m || depth_inside(room, ahead) < 0 ||
        !is_free(scene, eye))
      continue;
    Trajectory walk;
    for (std::size_t k = 0; k <= 2 * kMiddlePose; ++k) {
      const double t = (static_cast<double>(k) - kMiddlePose) / kRate_hz;
      const double a = yaw + share * turning * t;
      const double b = pitch + (1.0 - std::abs(share)) * turning * t;
      const Vector3d at = eye + speed * t * Vector3d(std::cos(course), std::sin(course), 0);
      const Vector3d way(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b));
      walk.push_back(
          {std::llround(static_cast<double>(k) * 1e9 / kRate_hz), look_at(at, at + way)});
    }
    walks.push_back(std::move(walk));
  }
  return walks;
}

}  // namespace mh
