// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/scan_views.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "bench/report/drawing/contact_sheet.hpp"
#include "scenes/dice.hpp"
#include "slam/core/angles.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kClearance_m = 0.3;

/// Signed distance to the walls: positive inside, negative outside.
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
    if (instance.max_m.z() <= scene.floor.middle_m.z() + scene.floor.rough_m ||
        instance.min_m.z() > eye.z() + kClearance_m)
      return false;
    const Eigen::Vector2d low = instance.min_m.head<2>().cast<double>(),
                          high = instance.max_m.head<2>().cast<double>();
    return (eye.head<2>() - eye.head<2>().cwiseMax(low).cwiseMin(high)).norm() < kClearance_m;
  });
}

}  // namespace

std::vector<SE3> scan_views(const Scene& scene, std::uint64_t seed, std::size_t count) {
  if (scene.rooms.empty()) throw InputError(fmt::format("scene {}: has no room", scene.name));
  Dice dice(RandomStream(seed).fork(0x77616c6b));
  std::vector<SE3> views;
  for (std::size_t tries = 0; views.size() < count; ++tries) {
    if (tries > 2000 * (count + 1))
      throw InputError(fmt::format("scene {}: no free place for a camera", scene.name));
    const Room& room = scene.rooms[dice.below(scene.rooms.size())];
    Vector2d low = room.polygon_m.front(), high = low;
    for (const Vector2d& p : room.polygon_m) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const double x = dice.number(low.x(), high.x()), y = dice.number(low.y(), high.y());
    const Vector3d eye(x, y, scene.floor.middle_m.z() + dice.number(1.1, 1.6));
    const double yaw = dice.number(-std::numbers::pi, std::numbers::pi);
    const double pitch = dice.number(-30, 12) * kDegree;
    // Four random numbers are drawn and discarded, so that a seed keeps giving the same views.
    for (int i = 0; i < 4; ++i) dice.number(0, 1);
    // A person does not scan a wall from very close: there must be free space 1 m ahead.
    const Vector2d ahead = eye.head<2>() + Vector2d(std::cos(yaw), std::sin(yaw));
    if (depth_inside(room, eye.head<2>()) < kClearance_m || depth_inside(room, ahead) < 0 ||
        !is_free(scene, eye))
      continue;
    const Vector3d way(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                       std::sin(pitch));
    views.push_back(look_at(eye, eye + way));
  }
  return views;
}

}  // namespace mh
