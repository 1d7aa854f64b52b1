// SPDX-License-Identifier: Apache-2.0

#include "sim/motion/motion.hpp"
#include "sim/motion/start.hpp"
#include "slam/core/angles.hpp"
#include "slam/io/yaml.hpp"

namespace mh {
namespace {

/// @param before_m where the robot is before this waypoint
Waypoint read_waypoint(YamlReader yaml, const Eigen::Vector2d& before_m) {
  Waypoint waypoint;
  waypoint.line = yaml.line();
  const auto to = yaml.find("to");
  waypoint.position_m = to ? read_place(*to) : before_m;
  if (const auto heading = yaml.find("heading_deg"))
    waypoint.heading_rad = heading->as_double(-360.0, 360.0) * kDegree;
  if (const auto face = yaml.find("face")) {
    if (waypoint.heading_rad) face->fail("is given together with heading_deg: give only one");
    if (face->is_sequence())
      waypoint.look_at_m = read_place(*face);
    else if (face->as_string() != "travel")
      face->fail("'" + face->as_string() + "' is neither 'travel' nor a position [x, y]");
  }
  waypoint.turn_rad = yaml.number_or("turn_deg", 0.0, -1080.0, 1080.0) * kDegree;
  waypoint.pause_s = yaml.number_or("pause_s", 0.0, 0.0, 600.0);
  yaml.finish();
  if (!to && !waypoint.heading_rad && waypoint.turn_rad == 0.0 && waypoint.pause_s == 0.0)
    yaml.fail("does nothing: give it 'to', 'heading_deg', 'turn_deg' or 'pause_s'");
  return waypoint;
}

}  // namespace

Tour load_tour(const std::filesystem::path& file) {
  YamlReader yaml = YamlReader::load(file);
  Tour tour;
  tour.file = file;
  tour.name = yaml.string("name");
  const Start start = read_start(yaml);
  tour.start_m = start.place_m;
  tour.start_heading_rad = start.heading_rad;
  tour.start_line = start.line;
  if (const auto speed = yaml.find("speed_m_per_s"))
    tour.max_velocity_m_per_s = speed->as_double(0.01, 5.0);
  if (const auto turn = yaml.find("turn_deg_per_s"))
    tour.max_turn_rad_per_s = turn->as_double(1.0, 360.0) * kDegree;
  tour.plan = yaml.boolean("plan", false);
  YamlReader list = yaml.at("waypoints");
  for (const YamlReader& item : list.items())
    tour.waypoints.push_back(read_waypoint(
        item, tour.waypoints.empty() ? tour.start_m : tour.waypoints.back().position_m));
  if (tour.waypoints.empty()) list.fail("a tour needs at least one waypoint");
  yaml.finish();
  return tour;
}

}  // namespace mh
