// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/start.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "slam/core/angles.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr double kDeepStart_m = 1e-3;

std::string name_of(const Scene& scene, InstanceId id) {
  if (id == 0) return "something";
  for (const Instance& instance : scene.instances)
    if (instance.id == id) return instance.name;
  return "a pedestrian";
}

}  // namespace

Eigen::Vector2d read_place(const YamlReader& yaml) {
  constexpr double kFar_m = 1000.0;
  yaml.as_numbers(2);
  const std::vector<YamlReader> xy = yaml.items();
  return {xy[0].as_double(-kFar_m, kFar_m), xy[1].as_double(-kFar_m, kFar_m)};
}

Start read_start(YamlReader& motion) {
  YamlReader yaml = motion.at("start");
  const YamlReader position = yaml.at("position");
  const Start start{.place_m = read_place(position),
                    .heading_rad = yaml.number("heading_deg", -360.0, 360.0) * kDegree,
                    .line = position.line()};
  yaml.finish();
  return start;
}

std::string file_and_line(const std::filesystem::path& file, int line) {
  return line > 0 ? fmt::format("{}:{}", file.string(), line) : file.string();
}

std::string outside_rooms(const Scene& scene, const Eigen::Vector2d& place_m) {
  const auto holds = [&](const Room& room) { return room.contains(place_m); };
  if (scene.rooms.empty() || std::ranges::any_of(scene.rooms, holds)) return "";
  return ", since it is in no room of " + scene.name;
}

std::string against(const Scene& scene, InstanceId id) {
  return id == 0 ? "" : " against " + name_of(scene, id);
}

void check_start(PlanarWorld& world, const Scene& scene, const Eigen::Vector2d& start_m,
                 const std::string& where) {
  const auto place = fmt::format("{}: start [{:.2f}, {:.2f}]", where, start_m.x(), start_m.y());
  const Contact contact = world.contact();
  if (contact.penetration_m > kDeepStart_m)
    throw InputError(fmt::format("{}: the robot would stand {:.0f} mm inside {}", place,
                                 1e3 * contact.penetration_m, name_of(scene, contact.instance)));
  if (const std::string outside = outside_rooms(scene, start_m); !outside.empty())
    throw InputError(fmt::format("{}: the robot cannot stand there{}", place, outside));
}

}  // namespace mh
