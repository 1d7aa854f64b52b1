// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "scenes/house/plan_parts.hpp"

namespace mh {
namespace {

constexpr double kNarrowestDoorway = 0.6;  // a 0.52 m wide robot needs some clearance

std::pair<double, double> read_span(const YamlReader& yaml) {
  const std::vector<double> n = yaml.as_numbers(2);
  if (n[0] >= n[1]) yaml.fail(fmt::format("[{}, {}] has no positive width", n[0], n[1]));
  return {n[0], n[1]};
}

/// The side of room a on which only a wall separates it from room b.
std::optional<Side> side_between(const HousePlan& house, const RoomPlan& a, const RoomPlan& b) {
  for (const Side side : kSides) {
    const double gap = std::abs(wall_at(a.rect, side) - wall_at(b.rect, opposite(side)));
    const auto [a0, a1] = wall_span(a.rect, side);
    const auto [b0, b1] = wall_span(b.rect, side);
    if (std::abs(gap - house.wall_m) < 1e-6 && std::min(a1, b1) - std::max(a0, b0) > 0) return side;
  }
  return std::nullopt;
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

}  // namespace

void read_doorways(const YamlReader& yaml, HousePlan& house) {
  for (const YamlReader& entry : yaml.items()) {
    OpeningPlan door = read_doorway(entry, house);
    check_openings_apart(entry, house, door);
    house.doorways.push_back(std::move(door));
  }
}

std::string doorways_text(const HouseFile& house) {
  std::string out = "doorways:\n";
  for (const OpeningPlan& door : house.doorways) {
    out += fmt::format("  - {{name: {}, rooms: [{}", door.name, house.rooms[door.room].name);
    if (door.other)
      out += fmt::format(", {}]", house.rooms[*door.other].name);
    else
      out += fmt::format("], side: {}", side_name(door.side));
    out += fmt::format(", span_m: [{:.3f}, {:.3f}], height_m: {:.3f}, closed: {}}}\n", door.from_m,
                       door.to_m, door.high_m, door.closed);
  }
  return out;
}

void read_windows(const YamlReader& yaml, HousePlan& house) {
  for (const YamlReader& entry : yaml.items()) {
    OpeningPlan window = read_window(entry, house);
    check_openings_apart(entry, house, window);
    house.windows.push_back(std::move(window));
  }
}

std::string windows_text(const HouseFile& house) {
  std::string out = "windows:\n";
  for (const OpeningPlan& window : house.windows)
    out += fmt::format(
        "  - {{name: {}, room: {}, side: {}, span_m: [{:.3f}, {:.3f}], sill_m: {:.3f}, "
        "head_m: {:.3f}, panes: {}}}\n",
        window.name, house.rooms[window.room].name, side_name(window.side), window.from_m,
        window.to_m, window.low_m, window.high_m, window.panes);
  return out;
}

}  // namespace mh
