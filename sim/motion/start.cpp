// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/start.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace mh {
namespace {

constexpr double kDeepStart_m = 1e-3;

bool contains(const Room& room, const Eigen::Vector2d& p) {
  bool inside = false;
  const auto& corners = room.polygon_m;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Eigen::Vector2d &a = corners[i], &b = corners[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

}  // namespace

std::string against(const Scene& scene, InstanceId id) {
  for (const Instance& instance : scene.instances)
    if (instance.id == id && id != 0) return " against " + instance.name;
  return "";
}

void check_start(PlanarWorld& world, const Scene& scene, const Eigen::Vector2d& start_m,
                 const std::string& where) {
  const auto place = fmt::format("{}: start [{:.2f}, {:.2f}]", where, start_m.x(), start_m.y());
  const Contact contact = world.contact();
  if (contact.penetration_m > kDeepStart_m)
    throw InputError(fmt::format("{}: the robot would stand {:.0f} mm inside something{}", place,
                                 1e3 * contact.penetration_m, against(scene, contact.instance)));
  const auto holds = [&](const Room& room) { return contains(room, start_m); };
  if (!scene.rooms.empty() && std::ranges::none_of(scene.rooms, holds))
    throw InputError(fmt::format("{}: lies in no room of {}", place, scene.name));
}

}  // namespace mh
