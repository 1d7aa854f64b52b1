// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "scenes/house/plan_parts.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

FloorRect read_cut(YamlReader yaml, const FloorRect& rect) {
  constexpr double kLeft = 0.8;  // width of the passage that must remain next to the cut
  const YamlReader corner = yaml.at("corner"), size = yaml.at("size_m");
  const std::string name = corner.as_string();
  const bool south = name.starts_with("south_"), west = name.ends_with("_west");
  if (name != fmt::format("{}_{}", south ? "south" : "north", west ? "west" : "east"))
    corner.fail(
        fmt::format("'{}' is not a corner; corners are south_west, south_east, north_west, "
                    "north_east",
                    name));
  const std::vector<double> n = size.as_numbers(2);
  if (n[0] <= 0 || n[1] <= 0 || n[0] > rect.x1 - rect.x0 - kLeft ||
      n[1] > rect.y1 - rect.y0 - kLeft)
    size.fail(fmt::format("[{}, {}] does not leave {} m of the room beside it", n[0], n[1], kLeft));
  yaml.finish();
  return {west ? rect.x0 : rect.x1 - n[0], south ? rect.y0 : rect.y1 - n[1],
          west ? rect.x0 + n[0] : rect.x1, south ? rect.y0 + n[1] : rect.y1};
}

void check_room(const YamlReader& yaml, const HousePlan& house, const RoomPlan& room) {
  const FloorRect &r = room.rect, &e = house.extent;
  if (!e.contains({r.x0, r.y0}, 1e-6) || !e.contains({r.x1, r.y1}, 1e-6))
    yaml.fail(fmt::format("room '{}' [{}, {}, {}, {}] lies outside the house [{}, {}, {}, {}]",
                          room.name, r.x0, r.y0, r.x1, r.y1, e.x0, e.y0, e.x1, e.y1));
  for (const RoomPlan& other : house.rooms) {
    if (other.name == room.name) yaml.fail(fmt::format("a second room is named '{}'", room.name));
    const double gap = std::max(
        {other.rect.x0 - r.x1, r.x0 - other.rect.x1, other.rect.y0 - r.y1, r.y0 - other.rect.y1});
    if (gap < -1e-6) yaml.fail(fmt::format("rooms '{}' and '{}' overlap", other.name, room.name));
    if (gap < house.wall_m - 1e-6)
      yaml.fail(fmt::format("between rooms '{}' and '{}' there is no room for a wall of {} m",
                            other.name, room.name, house.wall_m));
  }
}

}  // namespace

Side side_by_name(const YamlReader& yaml) {
  const std::string name = yaml.as_string();
  for (const Side side : kSides)
    if (side_name(side) == name) return side;
  yaml.fail(fmt::format("'{}' is not a side; sides are south, north, west, east", name));
}

FloorRect read_rect(const YamlReader& yaml) {
  const std::vector<double> n = yaml.as_numbers(4);
  if (n[0] >= n[2] || n[1] >= n[3])
    yaml.fail(fmt::format("[{}, {}, {}, {}] has no positive size: x from, y from, x to, y to", n[0],
                          n[1], n[2], n[3]));
  return {n[0], n[1], n[2], n[3]};
}

std::string rect_text(const FloorRect& rect) {
  return fmt::format("[{}, {}, {:.3f}, {:.3f}]", rect.x0, rect.y0, rect.x1, rect.y1);
}

std::size_t room_by_name(const YamlReader& yaml, const std::vector<RoomPlan>& rooms) {
  for (std::size_t i = 0; i < rooms.size(); ++i)
    if (rooms[i].name == yaml.as_string()) return i;
  yaml.fail(fmt::format("there is no room '{}'{}", yaml.as_string(),
                        hint(yaml.as_string(), words_of(rooms, &RoomPlan::name))));
}

void read_room(YamlReader& yaml, const Materials& materials, HousePlan& house) {
  RoomPlan room;
  room.name = yaml.string("name");
  room.rect = read_rect(yaml.at("rect_m"));
  room.floor = material_by_name(yaml.at("floor"), materials);
  room.ceiling = material_by_name(yaml.at("ceiling"), materials);
  YamlReader walls = yaml.at("walls");
  room.walls.fill(material_by_name(walls.at("all"), materials));
  for (const Side side : kSides)
    if (const auto one = walls.find(std::string(side_name(side))))
      room.walls[static_cast<std::size_t>(side)] = material_by_name(*one, materials);
  walls.finish();
  if (const auto cut = yaml.find("cut")) room.cut = read_cut(*cut, room.rect);
  check_room(yaml, house, room);
  house.rooms.push_back(std::move(room));
}

std::string room_text(const RoomEntry& room) {
  std::string out = fmt::format("  - name: {}\n    rect_m: {}\n", room.name, rect_text(room.rect));
  if (const auto& c = room.cut)
    out += fmt::format("    cut: {{corner: {}_{}, size_m: [{:.3f}, {:.3f}]}}\n",
                       c->y0 <= room.rect.y0 ? "south" : "north",
                       c->x0 <= room.rect.x0 ? "west" : "east", c->x1 - c->x0, c->y1 - c->y0);
  out += fmt::format("    floor: {}\n    ceiling: {}\n    walls: {{all: {}", room.floor,
                     room.ceiling, room.walls);
  for (const auto& [side, material] : room.special_walls)
    out += fmt::format(", {}: {}", side_name(side), material);
  out += "}\n";
  if (!room.items.empty()) out += "    items:\n";
  for (const ItemEntry& item : room.items) out += item_text(item);
  return out;
}

}  // namespace mh
