// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/floor.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/generate/describe.hpp"
#include "scenes/generate/furnish.hpp"
#include "scenes/generate/lamps.hpp"
#include "scenes/generate/shape.hpp"
#include "scenes/generate/surfaces.hpp"
#include "scenes/name_key.hpp"
#include "slam/io/error.hpp"

namespace mh::generate {
namespace {

constexpr double kWall_m = 0.12;
constexpr int kTriedDrafts = 400;   // rooms or corridors that are drawn until one is complete
constexpr int kAnyNumber = 10'000;  // number of objects, limited only by the rules
constexpr double kLeastFreeShare = 0.12;

/// Draws pieces according to all rules of the grammar. @returns whether all required pieces fit and
/// enough floor stays free
bool furnish_by_rules(Draft& draft) {
  draft.wanted_objects = kAnyNumber;
  for (const ItemRule& rule : draft.grammar.furniture)
    if (!add_by_rule(draft, rule)) return false;
  draft.fitting = true;
  for (const ItemRule& rule : draft.grammar.fittings) add_by_rule(draft, rule);
  draft.fitting = false;
  return draft.layout.free_share() >= kLeastFreeShare;
}

/// The design of the rooms: the door is in the south wall, windows are in the north wall.
std::optional<Draft> draw_room(const FloorGrammar& floor, double height_m, Dice dice) {
  const double area = draw(dice, floor.room.area_m2), aspect = draw(dice, floor.room.aspect);
  const double width = whole_mm(std::sqrt(area / aspect));
  Draft room{.grammar = floor.room,
             .dice = dice,
             .layout = {width, whole_mm(area / width), height_m, std::nullopt}};
  for (const Side side : {Side::kSouth, Side::kWest, Side::kEast}) room.layout.close(side);
  const double door = whole_mm(room.dice.number(0.9, 1.0));
  if (!add_door(room, room.layout.walls()[0], "door", door)) return std::nullopt;
  add_windows(room);
  choose_surfaces(room);
  if (!add_lamps(room)) return std::nullopt;
  room.daylight = draw_daylight(room.dice);
  if (!furnish_by_rules(room)) return std::nullopt;
  return room;
}

/// A room of this design with its own objects added.
Draft inhabited(const Draft& design, const DrawRange& objects, Dice dice) {
  Draft room = design;
  room.dice = dice;
  room.wanted_objects = room.layout.object_count() + draw_count(room.dice, objects);
  add_extras(room);
  return room;
}

/// Where a room is: the place of its origin in the floor's frame, about which the room may be
/// turned.
struct Place2d {
  Eigen::Vector2d at_m;
  bool turned = false;  ///< by 180 degrees

  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const {
    return whole_mm(turned ? Eigen::Vector2d(at_m - p) : Eigen::Vector2d(at_m + p));
  }
  FloorRect operator*(const FloorRect& r) const {
    const Eigen::Vector2d a = *this * Eigen::Vector2d(r.x0, r.y0),
                          b = *this * Eigen::Vector2d(r.x1, r.y1);
    return {std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.x(), b.x()),
            std::max(a.y(), b.y())};
  }
  Side operator*(Side side) const { return turned ? opposite(side) : side; }
  /// Moves an opening.
  void move(OpeningPlan& opening) const {
    const Eigen::Vector2d from = *this * Eigen::Vector2d::Constant(opening.from_m),
                          to = *this * Eigen::Vector2d::Constant(opening.to_m);
    const int axis = runs_along_x(opening.side) ? 0 : 1;
    opening.from_m = std::min(from[axis], to[axis]);
    opening.to_m = std::max(from[axis], to[axis]);
    opening.side = *this * opening.side;
  }
};

/// Adds the room of a one-room house to a house of several rooms. Its doorways are left out.
void add_room(HouseFile& floor, const HouseFile& house, const std::string& name,
              const Place2d& place) {
  std::map<std::string, std::string> materials;  // names in the house -> in the floor
  for (MaterialSpec material : house.materials) {
    const auto same = std::ranges::find_if(floor.materials, [&](const MaterialSpec& other) {
      return other.kind == material.kind && other.tone == material.tone &&
             other.variation == material.variation && other.seed == material.seed;
    });
    std::string& known = materials[material.name];
    known = same != floor.materials.end() ? same->name : name + "_" + material.name;
    if (same != floor.materials.end()) continue;
    material.name = known;
    floor.materials.push_back(material);
  }
  const auto own = [&](const std::string& material) { return materials.at(material); };
  RoomEntry room = house.rooms.front();
  room.name = name;
  room.rect = place * room.rect;
  room.floor = own(room.floor);
  room.ceiling = own(room.ceiling);
  room.walls = own(room.walls);
  std::map<Side, std::string> special;
  for (const auto& [side, material] : room.special_walls) special[place * side] = own(material);
  room.special_walls = std::move(special);
  for (ItemEntry& item : room.items) {
    for (auto& [role, material] : item.materials) material = own(material);
    if (!item.on.empty()) continue;  // it is placed in its carrier's frame
    item.at_m = place * item.at_m;
    if (place.turned) item.turn_deg = std::remainder(item.turn_deg + 180.0, 360.0);
  }
  for (OpeningPlan window : house.windows) {
    place.move(window);
    window.name = name + "_" + window.name;
    window.room = floor.rooms.size();
    floor.windows.push_back(window);
  }
  floor.rooms.push_back(std::move(room));
}

/// The corridor, with the doors of the rooms on both sides and an entrance and a window at its
/// ends.
std::optional<Draft> draw_corridor(const FloorGrammar& floor, const std::vector<OpeningPlan>& doors,
                                   double length_m, double width_m, double height_m, Dice dice) {
  Draft corridor{.grammar = floor.corridor,
                 .dice = dice,
                 .layout = {length_m, width_m, height_m, std::nullopt}};
  for (const OpeningPlan& door : doors) {
    const WallRun& wall = corridor.layout.walls()[static_cast<std::size_t>(door.side)];
    if (!corridor.layout.add_opening(wall, {.name = door.name,
                                            .from_m = door.from_m,
                                            .to_m = door.to_m,
                                            .low_m = 0,
                                            .high_m = door.high_m,
                                            .door = true}))
      return std::nullopt;
  }
  const WallRun& west = corridor.layout.walls()[static_cast<std::size_t>(Side::kWest)];
  if (!add_door(corridor, west, "entrance", 0.95)) return std::nullopt;
  for (const Side side : {Side::kSouth, Side::kNorth, Side::kWest}) corridor.layout.close(side);
  add_windows(corridor);
  choose_surfaces(corridor);
  if (!add_lamps(corridor) || !furnish_by_rules(corridor)) return std::nullopt;
  return corridor;
}

template <class Try>
Draft first_that_fits(const std::string& name, const char* what, const Try& attempt) {
  for (std::uint64_t k = 1; k <= kTriedDrafts; ++k)
    if (std::optional<Draft> draft = attempt(k)) return std::move(*draft);
  throw MachineError(fmt::format("{}: no {} in {} drafts had room for all that it needs", name,
                                 what, kTriedDrafts));
}

}  // namespace

GeneratedPlan generate_floor(const FloorGrammar& grammar, std::uint64_t seed) {
  const RandomStream stream = RandomStream(name_key(grammar.name)).fork(seed);
  const std::string name = fmt::format("{}-{}", grammar.name, seed);
  Dice dice(stream.fork(0));
  const int per_side = draw_count(dice, grammar.rooms_per_side);
  const double width = whole_mm(draw(dice, grammar.corridor_width_m));
  const double height = whole_mm(draw(dice, grammar.height_m));
  const Draft design = first_that_fits(name, "room", [&](std::uint64_t k) {
    return draw_room(grammar, height, Dice(stream.fork(1).fork(k)));
  });
  const FloorRect& rect = design.layout.rect();
  const double step = rect.x1 + kWall_m, length = whole_mm(per_side * step - kWall_m);
  // South to north: rooms turned around, the corridor, rooms as they were drawn.
  const double corridor_y = whole_mm(rect.y1 + kWall_m);
  std::vector<Place2d> places;
  std::vector<OpeningPlan> doors;  // the rooms' doors as openings of the corridor, in its frame
  const WallOpening& door = design.layout.openings().front();
  for (int k = 0; k < 2 * per_side; ++k) {
    const bool south = k >= per_side;
    const double x = (k % per_side) * step;
    places.push_back(south ? Place2d{{x + rect.x1, rect.y1}, true}
                           : Place2d{{x, corridor_y + width + kWall_m}});
    OpeningPlan plan{.name = fmt::format("door_{}", k + 1),
                     .other = static_cast<std::size_t>(k) + 1,
                     .side = Side::kSouth,
                     .from_m = door.from_m,
                     .to_m = door.to_m,
                     .high_m = door.high_m};
    places.back().move(plan);
    plan.side = opposite(plan.side);
    doors.push_back(plan);
  }
  const Draft corridor = first_that_fits(name, "corridor", [&](std::uint64_t k) {
    return draw_corridor(grammar, doors, length, width, height, Dice(stream.fork(2).fork(k)));
  });

  const HouseFile hall = describe(corridor, name);
  HouseFile floor;
  floor.comment = hall.comment;
  floor.name = name;
  floor.extent = {0, 0, length, whole_mm(corridor_y + width + kWall_m + rect.y1)};
  floor.height_m = height;
  floor.wall_m = hall.wall_m;
  add_room(floor, hall, "corridor", {{0, corridor_y}});
  floor.trim = "corridor_" + hall.trim;
  floor.window_frame = "corridor_" + hall.window_frame;
  floor.garden = hall.garden;
  floor.garden.material = "corridor_" + hall.garden.material;
  GeneratedPlan plan{.name = name, .room = fmt::format("{} rooms", 2 * per_side), .house = {}};
  const auto count = [&](const Draft& draft) {
    const double area = draft.layout.floor_area_m2();
    plan.free_share += draft.layout.free_share() * area;
    plan.floor_area_m2 += area;
    plan.objects += draft.layout.object_count();
    plan.fittings +=
        static_cast<int>(std::ranges::count(draft.layout.items(), true, &LayoutItem::fitting));
  };
  count(corridor);
  plan.objects -= 2 * per_side;  // the rooms' doors are counted with the rooms
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Draft room = inhabited(design, grammar.objects_of_its_own, Dice(stream.fork(3).fork(k)));
    add_room(floor, describe(room, name), fmt::format("room_{}", k + 1), places[k]);
    count(room);
  }
  plan.free_share /= plan.floor_area_m2;
  for (OpeningPlan opening : hall.doorways) {
    if (opening.name == "entrance") {
      Place2d{{0, corridor_y}}.move(opening);
      floor.doorways.push_back(opening);
    }
  }
  floor.doorways.insert(floor.doorways.end(), doors.begin(), doors.end());
  const HouseFile light = describe(design, name);
  floor.sun = light.sun;
  floor.sky = light.sky;
  floor.garden.glow = light.garden.glow;
  plan.house = std::move(floor);
  return plan;
}

}  // namespace mh::generate
