// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/house/plan_parts.hpp"
#include "slam/core/angles.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTouch = 0.01;  // m; furniture may touch: a smaller overlap is tolerated
constexpr double kFlat = 0.03;   // height of rugs, which people and furniture can be on

std::size_t piece_by_name(const YamlReader& yaml, const HousePlan& house, std::size_t room) {
  const std::string name = house.rooms[room].name + "/" + yaml.as_string();
  for (std::size_t i = 0; i < house.items.size(); ++i)
    if (house.items[i].name == name) return i;
  yaml.fail(fmt::format("there is no piece '{}' before this one in the room", yaml.as_string()));
}

/// Places a piece with its back to a wall: position and rotation follow from side, along and gap.
void place_against(YamlReader& yaml, const FloorRect& rect, ItemPlan& item) {
  const Side side = side_by_name(yaml.at("against"));
  const double along = yaml.number("along");
  const double gap = yaml.number_or("gap_m", item.kind->mount == Mount::kWall ? 0.002 : 0.01, 0.0);
  const double off = gap + item.size_m.y() / 2;
  const double wall = wall_at(rect, side);
  item.turn_rad = turn_before_wall_deg(side) * kDegree;
  if (runs_along_x(side))
    item.position_m.head<2>() = Vector2d(along, wall + inward(side) * off);
  else
    item.position_m.head<2>() = Vector2d(wall + inward(side) * off, along);
}

void read_size(YamlReader& yaml, ItemPlan& item) {
  item.size_m = item.kind->size_m.cast<double>();
  const auto size = yaml.find("size_m");
  if (!size) return;
  const std::vector<double> n = size->as_numbers(3);
  for (const double v : n)
    if (v <= 0) size->fail(fmt::format("size {} is not positive", v));
  item.size_m = {n[0], n[1], n[2]};
}

void read_item_materials(YamlReader& yaml, const Materials& materials, ItemPlan& item) {
  auto chosen = yaml.find("materials");
  if (!chosen) return;
  const std::string roles = fmt::format(" {} ", item.kind->roles);
  for (auto& [role, value] : chosen->entries()) {
    if (roles.find(fmt::format(" {} ", role)) == std::string::npos)
      value.fail(fmt::format("a {} has no part '{}'; it has: {}", item.kind->name, role,
                             item.kind->roles));
    item.materials.emplace(role, material_by_name(value, materials));
  }
}

/// Places a piece on another piece; `at` is in the carrier's frame.
void place_on(YamlReader& yaml, const HousePlan& house, ItemPlan& item) {
  const YamlReader on = yaml.at("on");
  item.on = piece_by_name(on, house, item.room);
  const ItemPlan& carrier = house.items[*item.on];
  const std::vector<double> at = yaml.at("at").as_numbers(2);
  if (std::abs(at[0]) > carrier.size_m.x() / 2 || std::abs(at[1]) > carrier.size_m.y() / 2)
    on.fail(fmt::format("[{}, {}] is not on '{}', which measures {} x {} m", at[0], at[1],
                        carrier.name, carrier.size_m.x(), carrier.size_m.y()));
  const double c = std::cos(carrier.turn_rad), s = std::sin(carrier.turn_rad);
  item.position_m = carrier.position_m +
                    Vector3d(c * at[0] - s * at[1], s * at[0] + c * at[1], carrier.size_m.z());
  item.turn_rad = carrier.turn_rad + yaml.number_or("turn_deg", 0.0, -360.0, 360.0) * kDegree;
}

ItemPlan read_item(YamlReader& yaml, const HousePlan& house, std::size_t room,
                   const Materials& materials) {
  ItemPlan item;
  item.room = room;
  item.name = house.rooms[room].name + "/" + yaml.string("name");
  for (const ItemPlan& other : house.items)
    if (other.name == item.name) yaml.fail(fmt::format("a second piece is named '{}'", item.name));
  const YamlReader kind = yaml.at("kind");
  item.kind = find_furniture(kind.as_string());
  if (!item.kind)
    kind.fail(fmt::format("unknown kind of furniture '{}'{}", kind.as_string(),
                          hint(kind.as_string(), words_of(furniture_kinds(), &FurnitureKind::name),
                               "modelhouse reference furniture lists all")));
  read_size(yaml, item);

  if (yaml.has("on")) {
    place_on(yaml, house, item);
    if (const auto z = yaml.find("z_m"))  // on a seat or a board rather than on the top
      item.position_m.z() =
          house.items[*item.on].position_m.z() + z->as_double(0.0, house.height_m);
  } else {
    if (yaml.has("against")) {
      place_against(yaml, house.rooms[room].rect, item);
    } else {
      const std::vector<double> at = yaml.at("at").as_numbers(2);
      item.position_m.head<2>() = Vector2d(at[0], at[1]);
      item.turn_rad = yaml.number_or("turn_deg", 0.0, -360.0, 360.0) * kDegree;
    }
    const bool hangs = item.kind->mount == Mount::kCeiling;
    item.position_m.z() =
        yaml.number_or("z_m", hangs ? house.height_m - item.size_m.z() : 0.0, 0.0, house.height_m);
  }
  if (const auto under = yaml.find("under")) item.under = piece_by_name(*under, house, room);
  read_item_materials(yaml, materials, item);
  if (const auto glow = yaml.find("glow")) {
    if (!item.kind->bulb) glow->fail(fmt::format("a {} gives no light", item.kind->name));
    item.glow = read_light_color(*glow);
  }
  yaml.finish();
  return item;
}

void check_in_room(const YamlReader& yaml, const HousePlan& house, const ItemPlan& item) {
  const RoomPlan& room = house.rooms[item.room];
  const Vector2d middle = item.position_m.head<2>();
  if (!room.rect.contains(middle)) {
    for (const RoomPlan& other : house.rooms)
      if (other.rect.contains(middle))
        yaml.fail(fmt::format("'{}' at [{:.2f}, {:.2f}] lies in room '{}'", item.name, middle.x(),
                              middle.y(), other.name));
    yaml.fail(fmt::format("'{}' at [{:.2f}, {:.2f}] lies outside all rooms", item.name, middle.x(),
                          middle.y()));
  }
  if (room.cut) {
    const FloorRect& c = *room.cut;
    const double depth =
        overlap_m(item.footprint(), {{{c.x0, c.y0}, {c.x1, c.y0}, {c.x1, c.y1}, {c.x0, c.y1}}});
    if (depth > kTouch)
      yaml.fail(fmt::format("'{}' reaches {:.2f} m into the corner cut out of room '{}'", item.name,
                            depth, room.name));
  }
  // Walls fill the space between the rooms' rectangles: a footprint that leaves its room intersects
  // a wall.
  for (const Vector2d& corner : item.footprint())
    if (!room.rect.contains(corner, kTouch))
      yaml.fail(fmt::format("'{}' overlaps a wall of room '{}' at [{:.2f}, {:.2f}]", item.name,
                            room.name, corner.x(), corner.y()));
  if (item.position_m.z() + item.size_m.z() > house.height_m + kTouch)
    yaml.fail(fmt::format("'{}' reaches to {:.2f} m, through the ceiling at {} m", item.name,
                          item.position_m.z() + item.size_m.z(), house.height_m));
}

void check_apart(const YamlReader& yaml, const ItemPlan& item, const ItemPlan& other) {
  if (item.on || other.on || item.room != other.room) return;
  if (item.size_m.z() <= kFlat || other.size_m.z() <= kFlat) return;
  const double low = std::max(item.position_m.z(), other.position_m.z());
  const double high =
      std::min(item.position_m.z() + item.size_m.z(), other.position_m.z() + other.size_m.z());
  if (high - low <= kTouch) return;
  const double depth = overlap_m(item.footprint(), other.footprint());
  if (depth > kTouch)
    yaml.fail(fmt::format("'{}' overlaps '{}' by {:.2f} m", item.name, other.name, depth));
}

}  // namespace

void read_items(const YamlReader& yaml, const Materials& materials, std::size_t room,
                HousePlan& house) {
  for (YamlReader& entry : yaml.items()) {
    ItemPlan item = read_item(entry, house, room, materials);
    check_in_room(entry, house, item);
    for (std::size_t i = 0; i < house.items.size(); ++i)
      if (item.under != i) check_apart(entry, item, house.items[i]);
    house.items.push_back(std::move(item));
  }
}

std::string item_text(const ItemEntry& item) {
  std::string out = fmt::format("      - {{name: {}, kind: {}", item.name, item.kind);
  if (!item.on.empty()) out += fmt::format(", on: {}", item.on);
  out += fmt::format(", at: [{:.3f}, {:.3f}], turn_deg: {:.1f}", item.at_m.x(), item.at_m.y(),
                     item.turn_deg);
  if (item.z_m) out += fmt::format(", z_m: {:.3f}", *item.z_m);
  if (!item.under.empty()) out += fmt::format(", under: {}", item.under);
  out += fmt::format(", size_m: [{:.3f}, {:.3f}, {:.3f}]", item.size_m.x(), item.size_m.y(),
                     item.size_m.z());
  if (item.glow)
    out += fmt::format(", glow: [{:.3f}, {:.3f}, {:.3f}]", item.glow->x(), item.glow->y(),
                       item.glow->z());
  if (!item.materials.empty()) {
    out += ", materials: {";
    std::string_view comma = "";
    for (const auto& [role, material] : item.materials) {
      out += fmt::format("{}{}: {}", comma, role, material);
      comma = ", ";
    }
    out += "}";
  }
  return out + "}\n";
}

}  // namespace mh
