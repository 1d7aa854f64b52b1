// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/describe.hpp"
#include "slam/core/angles.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace mh::generate {
namespace {

using Eigen::Vector3d;

std::vector<MaterialSpec> used_materials(const Draft& draft) {
  const Surfaces& s = draft.surfaces;
  std::set<std::string> used{s.floor, s.wall, s.ceiling, s.accent, s.trim, s.frame, s.garden};
  for (const LayoutItem& item : draft.layout.items())
    for (const auto& [role, material] : item.materials) used.insert(material);
  std::vector<MaterialSpec> materials;
  for (const MaterialSpec& material : draft.materials)
    if (used.contains(material.name)) materials.push_back(material);
  return materials;
}

ItemEntry describe_item(const Layout& layout, const LayoutItem& item) {
  const auto turned = [](double deg) { return std::remainder(deg, 360.0); };
  ItemEntry entry;
  entry.name = item.name;
  entry.kind = std::string(item.kind->name);
  entry.at_m = item.at_m;
  entry.turn_deg = turned(item.turn_deg);
  entry.size_m = item.size_m;
  entry.glow = item.glow;
  entry.materials = item.materials;
  if (item.on) {
    const LayoutItem& carrier = layout.item(*item.on);
    entry.on = carrier.name;
    entry.at_m = item.on_at_m;
    entry.turn_deg = turned(item.on_turn_deg);
    if (item.on_board) entry.z_m = item.z_m - carrier.z_m;
  } else {
    if (item.z_m > 0 && item.kind->mount != Mount::kCeiling) entry.z_m = item.z_m;
    if (item.under) entry.under = layout.item(*item.under).name;
  }
  return entry;
}

RoomEntry describe_room(const Draft& draft) {
  const Surfaces& surfaces = draft.surfaces;
  RoomEntry room;
  room.name = "room";
  room.rect = draft.layout.rect();
  room.cut = draft.layout.cut();
  room.floor = surfaces.floor;
  room.ceiling = surfaces.ceiling;
  room.walls = surfaces.wall;
  if (!surfaces.accent.empty()) room.special_walls[surfaces.accent_side] = surfaces.accent;
  for (const LayoutItem& item : draft.layout.items())
    room.items.push_back(describe_item(draft.layout, item));
  return room;
}

OpeningPlan describe_opening(const WallOpening& opening) {
  OpeningPlan plan;
  plan.name = opening.name;
  plan.side = opening.side;
  plan.from_m = opening.from_m;
  plan.to_m = opening.to_m;
  plan.low_m = opening.low_m;
  plan.high_m = opening.high_m;
  plan.closed = opening.door;
  if (!opening.door)
    plan.panes = std::max(1, static_cast<int>((opening.to_m - opening.from_m) / 0.75));
  return plan;
}

void describe_daylight(const Daylight& daylight, HouseFile& house) {
  house.garden.glow = daylight.dusk ? 0.012 : 0.03;
  // At dusk the sun is down and the sky is dimmer, but windows are not black.
  const double s = daylight.dusk ? 0.2 : 1.0;
  const double turn_rad = daylight.sun_turn_deg * kDegree;
  if (!daylight.dusk)
    house.sun = {
        Vector3d(0.6 * std::cos(turn_rad), 0.6 * std::sin(turn_rad), -0.7),
        Vector3d(daylight.sun_power, 0.94 * daylight.sun_power, 0.82 * daylight.sun_power)};
  house.sky = Vector3d(s * 0.86 * daylight.sky_power, s * 0.97 * daylight.sky_power,
                       s * 1.15 * daylight.sky_power);
}

}  // namespace

HouseFile describe(const Draft& draft, const std::string& name) {
  HouseFile house;
  house.comment = "Made by modelhouse scene make. docs/formats.md says what the keys mean.";
  house.name = name;
  house.extent = draft.layout.rect();
  house.height_m = draft.layout.height_m();
  house.wall_m = 0.12;
  house.materials = used_materials(draft);
  house.rooms = {describe_room(draft)};
  house.trim = draft.surfaces.trim;
  house.window_frame = draft.surfaces.frame;
  house.garden = {.material = draft.surfaces.garden, .distance_m = 11.0, .height_m = 7.0};
  for (const WallOpening& opening : draft.layout.openings())
    (opening.door ? house.doorways : house.windows).push_back(describe_opening(opening));
  describe_daylight(draft.daylight, house);
  return house;
}

}  // namespace mh::generate
