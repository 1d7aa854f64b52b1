// SPDX-License-Identifier: Apache-2.0
#include "scenes/house_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "slam/core/suggest.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kNarrowestDoorway = 0.6;  // a 0.52 m wide robot needs a little play
constexpr double kTouch = 0.01;  // furniture may touch: builders' tolerances, not an overlap
constexpr double kFlat = 0.03;   // rugs: things stand and people walk on them

using Materials = std::map<std::string, MaterialSpec>;

Side side_by_name(const YamlReader& yaml) {
  const std::string name = yaml.as_string();
  for (const Side side : kSides)
    if (side_name(side) == name) return side;
  yaml.fail(fmt::format("'{}' is no side; sides are south, north, west, east", name));
}

/// Inner face of the wall on a side of a room.
double wall_at(const FloorRect& rect, Side side) {
  switch (side) {
    case Side::kSouth:
      return rect.y0;
    case Side::kNorth:
      return rect.y1;
    case Side::kWest:
      return rect.x0;
    case Side::kEast:
      return rect.x1;
  }
  return 0;
}

std::pair<double, double> wall_span(const FloorRect& rect, Side side) {
  return runs_along_x(side) ? std::pair{rect.x0, rect.x1} : std::pair{rect.y0, rect.y1};
}

FloorRect read_rect(const YamlReader& yaml) {
  const std::vector<double> n = yaml.as_numbers(4);
  if (n[0] >= n[2] || n[1] >= n[3])
    yaml.fail(fmt::format("[{}, {}, {}, {}] has no positive size: x from, y from, x to, y to", n[0],
                          n[1], n[2], n[3]));
  return {n[0], n[1], n[2], n[3]};
}

Rgb8 read_tone(const YamlReader& yaml) {
  const std::vector<double> n = yaml.as_numbers(3);
  for (const double v : n)
    if (v < 0 || v > 255) yaml.fail(fmt::format("{} is outside [0, 255]", v));
  return {static_cast<std::uint8_t>(n[0]), static_cast<std::uint8_t>(n[1]),
          static_cast<std::uint8_t>(n[2])};
}

Eigen::Vector3f read_light_color(const YamlReader& yaml) {
  const std::vector<double> n = yaml.as_numbers(3);
  for (const double v : n)
    if (v < 0) yaml.fail(fmt::format("{} is negative; light cannot be", v));
  return Vector3d(n[0], n[1], n[2]).cast<float>();
}

Materials read_materials(YamlReader yaml) {
  Materials result;
  for (auto& [name, entry] : yaml.entries()) {
    MaterialSpec spec;
    spec.name = name;
    const YamlReader kind = entry.at("kind");
    spec.kind = kind.as_string();
    if (std::ranges::find(material_kinds(), spec.kind) == material_kinds().end())
      kind.fail(fmt::format("unknown kind of material '{}'{}", spec.kind,
                            hint(spec.kind, words_of(material_kinds()))));
    if (const auto tone = entry.find("tone")) spec.tone = read_tone(*tone);
    spec.variation = entry.number_or("variation", spec.variation, 0.0, 1.0);
    spec.seed = static_cast<std::uint64_t>(entry.integer_or("seed", 0, 0, 1'000'000'000));
    entry.finish();
    result.emplace(name, spec);
  }
  return result;
}

MaterialSpec material_by_name(const YamlReader& yaml, const Materials& materials) {
  const auto found = materials.find(yaml.as_string());
  if (found == materials.end())
    yaml.fail(fmt::format(
        "unknown material '{}'{}", yaml.as_string(),
        hint(yaml.as_string(), words_of(materials, [](const auto& m) { return m.first; }))));
  return found->second;
}

std::size_t room_by_name(const YamlReader& yaml, const std::vector<RoomPlan>& rooms) {
  for (std::size_t i = 0; i < rooms.size(); ++i)
    if (rooms[i].name == yaml.as_string()) return i;
  yaml.fail(fmt::format("there is no room '{}'{}", yaml.as_string(),
                        hint(yaml.as_string(), words_of(rooms, &RoomPlan::name))));
}

FloorRect read_cut(YamlReader yaml, const FloorRect& rect) {
  constexpr double kLeft = 0.8;  // a passage must be left beside it
  const YamlReader corner = yaml.at("corner"), size = yaml.at("size_m");
  const std::string name = corner.as_string();
  const bool south = name.starts_with("south_"), west = name.ends_with("_west");
  if (name != fmt::format("{}_{}", south ? "south" : "north", west ? "west" : "east"))
    corner.fail(
        fmt::format("'{}' is no corner; corners are south_west, south_east, north_west, "
                    "north_east",
                    name));
  const std::vector<double> n = size.as_numbers(2);
  if (n[0] <= 0 || n[1] <= 0 || n[0] > rect.x1 - rect.x0 - kLeft ||
      n[1] > rect.y1 - rect.y0 - kLeft)
    size.fail(fmt::format("[{}, {}] is no part of the room that leaves {} m beside it", n[0], n[1],
                          kLeft));
  yaml.finish();
  return {west ? rect.x0 : rect.x1 - n[0], south ? rect.y0 : rect.y1 - n[1],
          west ? rect.x0 + n[0] : rect.x1, south ? rect.y0 + n[1] : rect.y1};
}

RoomPlan read_room(YamlReader& yaml, const Materials& materials) {
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
  return room;
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

std::pair<double, double> read_span(const YamlReader& yaml) {
  const std::vector<double> n = yaml.as_numbers(2);
  if (n[0] >= n[1]) yaml.fail(fmt::format("[{}, {}] has no positive width", n[0], n[1]));
  return {n[0], n[1]};
}

/// The side of room a on which room b lies across one wall.
std::optional<Side> side_between(const HousePlan& house, const RoomPlan& a, const RoomPlan& b) {
  for (const Side side : kSides) {
    const double gap = std::abs(wall_at(a.rect, side) - wall_at(b.rect, opposite(side)));
    const auto [a0, a1] = wall_span(a.rect, side);
    const auto [b0, b1] = wall_span(b.rect, side);
    if (std::abs(gap - house.wall_m) < 1e-6 && std::min(a1, b1) - std::max(a0, b0) > 0) return side;
  }
  return std::nullopt;
}

/// The stretch of a room's wall: what a missing corner takes of it is none.
std::pair<double, double> wall_span(const RoomPlan& room, Side side) {
  auto [low, high] = wall_span(room.rect, side);
  if (!room.cut || wall_at(*room.cut, side) != wall_at(room.rect, side)) return {low, high};
  const auto [cut_low, cut_high] = wall_span(*room.cut, side);
  (cut_low <= low ? low : high) = cut_low <= low ? cut_high : cut_low;
  return {low, high};
}

void check_in_wall(const YamlReader& yaml, const HousePlan& house, const OpeningPlan& opening) {
  auto [low, high] = wall_span(house.rooms[opening.room], opening.side);
  if (opening.other) {
    const auto [other_low, other_high] =
        wall_span(house.rooms[*opening.other], opposite(opening.side));
    low = std::max(low, other_low);
    high = std::min(high, other_high);
  }
  if (opening.from_m < low || opening.to_m > high)
    yaml.fail(fmt::format("'{}' from {} to {} m is not in the wall, which runs from {} to {} m",
                          opening.name, opening.from_m, opening.to_m, low, high));
}

OpeningPlan read_doorway(YamlReader yaml, const HousePlan& house) {
  OpeningPlan door;
  door.name = yaml.string("name");
  const YamlReader rooms = yaml.at("rooms");
  const std::vector<YamlReader> names = rooms.items();
  if (names.empty() || names.size() > 2) rooms.fail("names one room, or the two that it joins");
  door.room = room_by_name(names[0], house.rooms);
  if (names.size() == 2) {
    door.other = room_by_name(names[1], house.rooms);
    const auto side = side_between(house, house.rooms[door.room], house.rooms[*door.other]);
    if (!side)
      rooms.fail(fmt::format("doorway '{}' is in no wall: rooms '{}' and '{}' have none in common",
                             door.name, names[0].as_string(), names[1].as_string()));
    door.side = *side;
  } else {
    door.side = side_by_name(yaml.at("side"));
  }
  const YamlReader span = yaml.at("span_m");
  std::tie(door.from_m, door.to_m) = read_span(span);
  if (door.to_m - door.from_m < kNarrowestDoorway)
    span.fail(fmt::format("doorway '{}' is {:.3g} m wide, narrower than {} m", door.name,
                          door.to_m - door.from_m, kNarrowestDoorway));
  door.high_m = yaml.number("height_m", 0.1, house.height_m - 0.05);
  door.closed = yaml.boolean("closed", false);
  if (!door.other && !door.closed)
    yaml.fail(fmt::format("doorway '{}' leads outside and must be closed", door.name));
  yaml.finish();
  check_in_wall(span, house, door);
  return door;
}

OpeningPlan read_window(YamlReader yaml, const HousePlan& house) {
  OpeningPlan window;
  window.name = yaml.string("name");
  window.room = room_by_name(yaml.at("room"), house.rooms);
  window.side = side_by_name(yaml.at("side"));
  const YamlReader span = yaml.at("span_m");
  std::tie(window.from_m, window.to_m) = read_span(span);
  window.low_m = yaml.number("sill_m", 0.05, house.height_m - 0.05);
  window.high_m = yaml.number("head_m", window.low_m + 0.1, house.height_m - 0.05);
  window.panes = static_cast<int>(yaml.integer_or("panes", 1, 1, 12));
  yaml.finish();
  check_in_wall(span, house, window);
  if (std::abs(wall_at(house.rooms[window.room].rect, window.side) -
               wall_at(house.extent, window.side)) > 1e-6)
    yaml.fail(fmt::format("window '{}' is not in an outer wall", window.name));
  return window;
}

void check_openings_apart(const YamlReader& yaml, const HousePlan& house,
                          const OpeningPlan& added) {
  const auto faces = [](const OpeningPlan& o, std::size_t room) {
    return o.room == room || o.other == room;
  };
  for (const auto* list : {&house.doorways, &house.windows})
    for (const OpeningPlan& o : *list) {
      if (o.name == added.name) yaml.fail(fmt::format("a second opening is named '{}'", o.name));
      if (faces(o, added.room) && o.side == added.side && o.room == added.room &&
          std::min(o.to_m, added.to_m) > std::max(o.from_m, added.from_m))
        yaml.fail(fmt::format("'{}' and '{}' overlap", o.name, added.name));
    }
}

// ---- furniture -------------------------------------------------------------------------------

std::size_t piece_by_name(const YamlReader& yaml, const HousePlan& house, std::size_t room,
                          std::size_t self) {
  const std::string name = house.rooms[room].name + "/" + yaml.as_string();
  for (std::size_t i = 0; i < house.items.size(); ++i)
    if (house.items[i].name == name && i != self) return i;
  yaml.fail(fmt::format("there is no piece '{}' before this one in the room", yaml.as_string()));
}

/// Puts the back of a piece to a wall: position and turn follow from side, along and gap.
void place_against(YamlReader& yaml, const FloorRect& rect, ItemPlan& item) {
  constexpr std::array kTurn = {180.0, 0.0, 90.0, -90.0};  // its front (-y) faces the room
  const Side side = side_by_name(yaml.at("against"));
  const double along = yaml.number("along");
  const double gap = yaml.number_or("gap_m", item.kind->mount == Mount::kWall ? 0.002 : 0.01, 0.0);
  const double off = gap + item.size_m.y() / 2;
  const double wall = wall_at(rect, side);
  const double inward = side == Side::kSouth || side == Side::kWest ? 1.0 : -1.0;
  item.turn_rad = kTurn[static_cast<std::size_t>(side)] * kDegree;
  if (runs_along_x(side))
    item.position_m.head<2>() = Vector2d(along, wall + inward * off);
  else
    item.position_m.head<2>() = Vector2d(wall + inward * off, along);
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

/// Where on another piece it stands: `at` counts in the carrier's frame.
void place_on(YamlReader& yaml, const HousePlan& house, ItemPlan& item) {
  const YamlReader on = yaml.at("on");
  item.on = piece_by_name(on, house, item.room, house.items.size());
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

ItemPlan read_item(YamlReader yaml, const HousePlan& house, std::size_t room,
                   const Materials& materials) {
  ItemPlan item(yaml);
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
  if (const auto under = yaml.find("under"))
    item.under = piece_by_name(*under, house, room, house.items.size());
  read_item_materials(yaml, materials, item);
  if (const auto glow = yaml.find("glow")) {
    if (!item.kind->bulb) glow->fail(fmt::format("a {} gives no light", item.kind->name));
    item.glow = read_light_color(*glow);
  }
  yaml.finish();
  return item;
}

void check_in_room(const HousePlan& house, const ItemPlan& item) {
  const RoomPlan& room = house.rooms[item.room];
  const Vector2d middle = item.position_m.head<2>();
  if (!room.rect.contains(middle)) {
    for (const RoomPlan& other : house.rooms)
      if (other.rect.contains(middle))
        item.where.fail(fmt::format("'{}' at [{:.2f}, {:.2f}] lies in room '{}'", item.name,
                                    middle.x(), middle.y(), other.name));
    item.where.fail(fmt::format("'{}' at [{:.2f}, {:.2f}] lies outside all rooms", item.name,
                                middle.x(), middle.y()));
  }
  if (room.cut) {
    const FloorRect& c = *room.cut;
    const double depth =
        overlap_m(item.footprint(), {{{c.x0, c.y0}, {c.x1, c.y0}, {c.x1, c.y1}, {c.x0, c.y1}}});
    if (depth > kTouch)
      item.where.fail(fmt::format("'{}' stands {:.2f} m in the corner that room '{}' lacks",
                                  item.name, depth, room.name));
  }
  // Walls are what lies between the inner rectangles: a footprint that leaves its room enters one.
  for (const Vector2d& corner : item.footprint())
    if (!room.rect.contains(corner, kTouch))
      item.where.fail(fmt::format("'{}' overlaps a wall of room '{}' at [{:.2f}, {:.2f}]",
                                  item.name, room.name, corner.x(), corner.y()));
  if (item.position_m.z() + item.size_m.z() > house.height_m + kTouch)
    item.where.fail(fmt::format("'{}' reaches to {:.2f} m, through the ceiling at {} m", item.name,
                                item.position_m.z() + item.size_m.z(), house.height_m));
}

void check_apart(const ItemPlan& item, const ItemPlan& other) {
  if (item.on || other.on || item.room != other.room) return;
  if (item.size_m.z() <= kFlat || other.size_m.z() <= kFlat) return;
  const double low = std::max(item.position_m.z(), other.position_m.z());
  const double high =
      std::min(item.position_m.z() + item.size_m.z(), other.position_m.z() + other.size_m.z());
  if (high - low <= kTouch) return;
  const double depth = overlap_m(item.footprint(), other.footprint());
  if (depth > kTouch)
    item.where.fail(fmt::format("'{}' overlaps '{}' by {:.2f} m", item.name, other.name, depth));
}

void read_items(YamlReader yaml, const Materials& materials, std::size_t room, HousePlan& house) {
  for (YamlReader& entry : yaml.items()) {
    ItemPlan item = read_item(std::move(entry), house, room, materials);
    check_in_room(house, item);
    for (std::size_t i = 0; i < house.items.size(); ++i)
      if (item.under != i) check_apart(item, house.items[i]);
    house.items.push_back(std::move(item));
  }
}

void read_lights(YamlReader yaml, HousePlan& house) {
  if (auto sun = yaml.find("sun")) {
    const YamlReader direction = sun->at("direction");
    const std::vector<double> n = direction.as_numbers(3);
    const Vector3d way(n[0], n[1], n[2]);
    if (way.norm() < 1e-6 || way.z() >= 0) direction.fail("must point downwards");
    house.sun = Light{.kind = Light::Kind::kSun,
                      .direction = way.normalized().cast<float>(),
                      .color = read_light_color(sun->at("color"))};
    sun->finish();
  }
  if (auto sky = yaml.find("sky")) {
    house.sky = Light{.kind = Light::Kind::kSky, .color = read_light_color(sky->at("color"))};
    sky->finish();
  }
  yaml.finish();
}

}  // namespace

std::string_view side_name(Side side) {
  constexpr std::array<std::string_view, 4> kNames = {"south", "north", "west", "east"};
  return kNames[static_cast<std::size_t>(side)];
}

std::vector<Vector2d> RoomPlan::outline_m() const {
  const FloorRect& r = rect;
  std::vector<Vector2d> corners = {{r.x0, r.y0}, {r.x1, r.y0}, {r.x1, r.y1}, {r.x0, r.y1}};
  if (!cut) return corners;
  const bool south = cut->y0 <= r.y0, west = cut->x0 <= r.x0;
  const std::size_t missing = south ? (west ? 0 : 1) : (west ? 3 : 2);
  // Counter-clockwise: the end of the wall before the missing corner, the inner corner, the next.
  const Vector2d inner(west ? cut->x1 : cut->x0, south ? cut->y1 : cut->y0);
  const Vector2d on_x(inner.x(), south ? r.y0 : r.y1), on_y(west ? r.x0 : r.x1, inner.y());
  const bool y_first = south == west;
  const std::array<Vector2d, 3> step = {y_first ? on_y : on_x, inner, y_first ? on_x : on_y};
  corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(missing));
  corners.insert(corners.begin() + static_cast<std::ptrdiff_t>(missing), step.begin(), step.end());
  return corners;
}

std::array<Vector2d, 4> ItemPlan::footprint() const {
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  std::array<Vector2d, 4> result;
  constexpr std::array<std::array<double, 2>, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = kCorners[i][0] * size_m.x() / 2, y = kCorners[i][1] * size_m.y() / 2;
    result[i] = position_m.head<2>() + Vector2d(c * x - s * y, s * x + c * y);
  }
  return result;
}

double overlap_m(const std::array<Vector2d, 4>& a, const std::array<Vector2d, 4>& b) {
  // Separating axes: the least overlap over all edge normals.
  double least = std::numeric_limits<double>::infinity();
  for (const auto* quad : {&a, &b})
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2d edge = (*quad)[(i + 1) % 4] - (*quad)[i];
      const Vector2d normal = Vector2d(edge.y(), -edge.x()).normalized();
      double a_low = 1e30, a_high = -1e30, b_low = 1e30, b_high = -1e30;
      for (std::size_t k = 0; k < 4; ++k) {
        a_low = std::min(a_low, normal.dot(a[k]));
        a_high = std::max(a_high, normal.dot(a[k]));
        b_low = std::min(b_low, normal.dot(b[k]));
        b_high = std::max(b_high, normal.dot(b[k]));
      }
      least = std::min(least, std::min(a_high, b_high) - std::max(a_low, b_low));
    }
  return least;
}

HousePlan read_house_plan(YamlReader yaml) {
  HousePlan house;
  house.name = yaml.string("name");
  const YamlReader extent = yaml.at("extent_m");
  house.extent = read_rect(extent);
  constexpr double kMost_m = 500;
  for (const double meters : {house.extent.x1 - house.extent.x0, house.extent.y1 - house.extent.y0})
    if (meters > kMost_m)
      extent.fail(fmt::format("is {} m long; {} m is the most", meters, kMost_m));
  house.height_m = yaml.number("height_m", 2.0, 10.0);
  house.wall_m = yaml.number("wall_thickness_m", 0.02, 1.0);
  house.detail = yaml.number_or("detail", house.detail, 0.5, 8.0);
  const Materials materials = read_materials(yaml.at("materials"));
  house.trim = material_by_name(yaml.at("trim"), materials);
  house.window_frame = material_by_name(yaml.at("window_frame"), materials);

  std::vector<YamlReader> rooms = yaml.at("rooms").items();
  for (YamlReader& entry : rooms) {
    RoomPlan room = read_room(entry, materials);
    check_room(entry, house, room);
    house.rooms.push_back(std::move(room));
  }
  if (const auto doorways = yaml.find("doorways"))
    for (const YamlReader& entry : doorways->items()) {
      OpeningPlan door = read_doorway(entry, house);
      check_openings_apart(entry, house, door);
      house.doorways.push_back(std::move(door));
    }
  if (const auto windows = yaml.find("windows"))
    for (const YamlReader& entry : windows->items()) {
      OpeningPlan window = read_window(entry, house);
      check_openings_apart(entry, house, window);
      house.windows.push_back(std::move(window));
    }
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    if (auto items = rooms[i].find("items")) read_items(std::move(*items), materials, i, house);
    rooms[i].finish();
  }
  if (auto garden = yaml.find("garden")) {
    GardenPlan plan;
    plan.material = material_by_name(garden->at("material"), materials);
    plan.distance_m = garden->number("distance_m", 1.0, 1000.0);
    plan.height_m = garden->number("height_m", 0.1, 1000.0);
    plan.glow = garden->number_or("glow", plan.glow, 0.0);
    garden->finish();
    house.garden = plan;
  }
  if (auto lights = yaml.find("lights")) read_lights(std::move(*lights), house);
  yaml.finish();
  return house;
}

}  // namespace mh
