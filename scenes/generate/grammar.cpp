// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/grammar.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "scenes/furniture/furniture.hpp"
#include "scenes/generate/data.hpp"
#include "slam/io/suggest.hpp"
#include "slam/io/yaml.hpp"

namespace mh {
namespace {

DrawRange as_range(const YamlReader& yaml, double min, double max) {
  if (yaml.is_scalar()) {
    const double v = yaml.as_double(min, max);
    return {v, v};
  }
  const std::vector<double> n = yaml.as_numbers(2);
  if (n[0] > n[1] || n[0] < min || n[1] > max)
    yaml.fail(fmt::format("[{}, {}] is not a range within [{}, {}]", n[0], n[1], min, max));
  return {n[0], n[1]};
}

DrawRange range_or(YamlReader& yaml, const std::string& key, DrawRange fallback, double min,
                   double max) {
  const auto found = yaml.find(key);
  return found ? as_range(*found, min, max) : fallback;
}

std::vector<std::string> as_names(const YamlReader& yaml) {
  if (yaml.is_scalar()) return {yaml.as_string()};
  std::vector<std::string> names;
  for (const YamlReader& item : yaml.items()) names.push_back(item.as_string());
  if (names.empty()) yaml.fail("is empty");
  return names;
}

PaletteEntry read_entry(YamlReader yaml) {
  PaletteEntry entry;
  const YamlReader kind = yaml.at("kind");
  entry.kind = kind.as_string();
  if (std::ranges::find(material_kinds(), entry.kind) == material_kinds().end())
    kind.fail(fmt::format("unknown kind of material '{}'", entry.kind));
  for (const YamlReader& tone : yaml.at("tones").items()) {
    const std::vector<double> n = tone.as_numbers(3);
    if (std::ranges::any_of(n, [](double v) { return v < 0 || v > 255; }))
      tone.fail("is not a color: three numbers from 0 to 255");
    entry.tones.push_back({static_cast<std::uint8_t>(n[0]), static_cast<std::uint8_t>(n[1]),
                           static_cast<std::uint8_t>(n[2])});
  }
  if (entry.tones.empty()) yaml.fail("has no tones");
  entry.variation = range_or(yaml, "variation", {0.2, 0.5}, 0.0, 1.0);
  yaml.finish();
  return entry;
}

Palettes read_palettes(YamlReader yaml) {
  Palettes result;
  for (auto& [name, list] : yaml.at("palettes").entries())
    for (YamlReader& entry : list.items()) result.lists[name].push_back(read_entry(entry));
  const auto known = [&](const YamlReader& name) {
    if (!result.lists.contains(name.as_string()))
      name.fail(fmt::format("unknown palette '{}'", name.as_string()));
    return name.as_string();
  };
  for (auto& [role, list] : yaml.at("roles").entries()) result.list_of_role[role] = known(list);
  for (const YamlReader& name : yaml.at("fresh").items()) result.fresh.push_back(known(name));
  for (const YamlReader& name : yaml.at("varied").items()) {
    if (find_furniture(name.as_string()) == nullptr)
      name.fail(fmt::format("unknown kind of furniture '{}'", name.as_string()));
    result.varied.push_back(name.as_string());
  }
  yaml.finish();
  return result;
}

std::vector<std::string> palette_names(const YamlReader& yaml) {
  std::vector<std::string> names = as_names(yaml);
  for (const std::string& name : names)
    if (!palettes().lists.contains(name)) yaml.fail(fmt::format("unknown palette '{}'", name));
  return names;
}

std::map<std::string, std::string> read_roles(YamlReader& yaml, const std::string& key) {
  std::map<std::string, std::string> roles;
  if (auto found = yaml.find(key))
    for (auto& [role, list] : found->entries()) roles[role] = palette_names(list).at(0);
  return roles;
}

Place read_place(const YamlReader& yaml, bool belongs) {
  using enum Place;
  static const std::map<std::string, Place> alone = {
      {"wall", kWall},     {"corner", kCorner}, {"center", kCenter},   {"floor", kFloor},
      {"hang", kHang},     {"along", kAlong},   {"rows", kRows},       {"aisles", kAisles},
      {"window", kWindow}, {"door", kDoor},     {"ceiling", kCeiling}, {"on", kOnAny}};
  static const std::map<std::string, Place> part = {
      {"on", kOn}, {"beside", kBeside}, {"front", kFront}, {"around", kAround}, {"above", kAbove}};
  const auto& names = belongs ? part : alone;
  const auto found = names.find(yaml.as_string());
  if (found == names.end()) yaml.fail(fmt::format("unknown place '{}'", yaml.as_string()));
  return found->second;
}

ItemRule read_rule(YamlReader yaml, bool belongs) {
  ItemRule rule;
  const YamlReader kinds = yaml.at("kind");
  rule.kinds = as_names(kinds);
  const auto known = [](const YamlReader& place, const std::vector<std::string>& names) {
    for (const std::string& name : names)
      if (find_furniture(name) == nullptr)
        place.fail(fmt::format("unknown kind of furniture '{}'", name));
  };
  known(kinds, rule.kinds);
  rule.place = read_place(yaml.at("place"), belongs);
  rule.need = yaml.boolean("need", false);
  rule.fitting = yaml.boolean("fitting", false);
  rule.chance = yaml.number_or("chance", 1.0, 0.0, 1.0);
  rule.weight = yaml.number_or("weight", 1.0, 0.0, 100.0);
  rule.most = static_cast<int>(yaml.number_or("most", rule.most, 1, 1000));
  rule.count = range_or(yaml, "count", rule.count, 0, 100);
  if (const auto size = yaml.find("size_m")) {
    const std::vector<YamlReader> axes = size->items();
    if (axes.size() != 3) size->fail("must give width, depth and height");
    rule.size_m.emplace();
    for (std::size_t k = 0; k < 3; ++k) (*rule.size_m)[k] = as_range(axes[k], 0.005, 20.0);
  }
  if (const auto z = yaml.find("z_m")) rule.z_m = as_range(*z, 0.0, 10.0);
  rule.gap_m = range_or(yaml, "gap_m", rule.gap_m, -1.0, 5.0);
  rule.turn_deg = range_or(yaml, "turn_deg", rule.turn_deg, -360, 360);
  rule.front_m = yaml.number_or("front_m", 0.0, 0.0, 3.0);
  rule.spacing_m = range_or(yaml, "spacing_m", rule.spacing_m, 0.0, 5.0);
  if (const auto zone = yaml.find("zone")) {
    const std::vector<double> n = zone->as_numbers(4);
    std::ranges::copy(n, rule.zone.begin());
  }
  if (rule.place == Place::kOnAny) {
    const YamlReader carriers = yaml.at("carriers");
    rule.carriers = as_names(carriers);
    known(carriers, rule.carriers);
  }
  rule.materials = read_roles(yaml, "materials");
  if (auto with = yaml.find("with"))
    for (YamlReader& part : with->items()) rule.with.push_back(read_rule(part, true));
  yaml.finish();
  return rule;
}

std::vector<ItemRule> read_rules(const YamlReader& yaml) {
  std::vector<ItemRule> rules;
  for (YamlReader& rule : yaml.items()) rules.push_back(read_rule(rule, false));
  return rules;
}

/// Reads everything about a room except its name and shape, then calls finish() on the mapping.
void read_interior(YamlReader& yaml, RoomGrammar& room) {
  room.windows = range_or(yaml, "windows", room.windows, 0, 12);
  room.window_width_m = range_or(yaml, "window_width_m", room.window_width_m, 0.3, 5.0);
  room.window_sill_m = range_or(yaml, "window_sill_m", room.window_sill_m, 0.05, 2.5);
  room.window_head_m = range_or(yaml, "window_head_m", room.window_head_m, 0.5, 6.0);
  room.floors = palette_names(yaml.at("floors"));
  room.walls = palette_names(yaml.at("walls"));
  room.ceilings = palette_names(yaml.at("ceilings"));
  room.accent_chance = yaml.number_or("accent", room.accent_chance, 0.0, 1.0);
  const YamlReader lamp = yaml.at("lamp");
  room.lamp = lamp.as_string();
  const FurnitureKind* const kind = find_furniture(room.lamp);
  if (kind == nullptr || !kind->bulb) lamp.fail(fmt::format("'{}' is not a lamp", room.lamp));
  room.area_per_lamp_m2 = yaml.number_or("area_per_lamp_m2", room.area_per_lamp_m2, 0.5, 100.0);
  room.lamp_power = range_or(yaml, "lamp_power", room.lamp_power, 0.0, 100.0);
  room.warmth = range_or(yaml, "warmth", room.warmth, 0.0, 1.0);
  room.roles = read_roles(yaml, "roles");
  room.furniture = read_rules(yaml.at("furniture"));
  if (const auto extras = yaml.find("extras")) room.extras = read_rules(*extras);
  if (const auto fittings = yaml.find("fittings")) room.fittings = read_rules(*fittings);
  yaml.finish();
}

RoomGrammar read_room(YamlReader yaml) {
  RoomGrammar room;
  room.name = yaml.string("name");
  room.area_m2 = as_range(yaml.at("area_m2"), 2.0, 400.0);
  room.aspect = as_range(yaml.at("aspect"), 1.0, 12.0);
  room.height_m = as_range(yaml.at("height_m"), 2.1, 8.0);
  room.cut_chance = yaml.number_or("cut", 0.0, 0.0, 1.0);
  room.cut_share = range_or(yaml, "cut_share", room.cut_share, 0.1, 0.8);
  room.doors = range_or(yaml, "doors", room.doors, 1, 12);
  const YamlReader density = yaml.at("density");
  std::ranges::copy(density.as_numbers(4), room.density.begin());
  read_interior(yaml, room);
  return room;
}

FloorGrammar read_floor(YamlReader yaml) {
  FloorGrammar floor;
  floor.name = yaml.string("name");
  floor.rooms_per_side = as_range(yaml.at("rooms_per_side"), 1, 20);
  floor.corridor_width_m = as_range(yaml.at("corridor_width_m"), 1.3, 6.0);
  floor.height_m = as_range(yaml.at("height_m"), 2.1, 8.0);
  floor.objects_of_its_own = as_range(yaml.at("objects_of_its_own"), 0, 100);
  YamlReader room = yaml.at("room"), corridor = yaml.at("corridor");
  floor.room.name = "room";
  floor.room.area_m2 = as_range(room.at("area_m2"), 5.0, 100.0);
  floor.room.aspect = as_range(room.at("aspect"), 0.5, 3.0);
  read_interior(room, floor.room);
  floor.corridor.name = "corridor";
  read_interior(corridor, floor.corridor);
  yaml.finish();
  return floor;
}

Category read_category(YamlReader yaml) {
  Category category;
  category.name = yaml.string("name");
  category.count = static_cast<int>(yaml.integer("count", 1, 1000));
  for (YamlReader& room : yaml.at("rooms").items()) category.rooms.push_back(read_room(room));
  yaml.finish();
  return category;
}

/// Reads the embedded files with these names, in this order.
template <class Names, class Read>
auto read_all(const Names& names, const Read& read) {
  std::vector<decltype(read(YamlReader::parse("", "")))> list;
  for (const std::string_view name : names)
    list.push_back(
        read(YamlReader::parse(std::string(generator_data(name)), fmt::format("{}.yaml", name))));
  return list;
}

}  // namespace

const Palettes& palettes() {
  static const Palettes all =
      read_palettes(YamlReader::parse(std::string(generator_data("palettes")), "palettes.yaml"));
  return all;
}

const std::vector<Category>& categories() {
  static const std::vector<Category> all = read_all(kCategoryNames, read_category);
  return all;
}

const std::vector<FloorGrammar>& floors() {
  static const std::vector<FloorGrammar> all = read_all(kFloorNames, read_floor);
  return all;
}

const FloorGrammar* floor_by_name(std::string_view name) {
  const auto found = std::ranges::find(floors(), name, &FloorGrammar::name);
  return found == floors().end() ? nullptr : &*found;
}

const Category& category_by_name(std::string_view name) {
  const auto& all = categories();
  const auto found = std::ranges::find(all, name, &Category::name);
  if (found != all.end()) return *found;
  std::vector<std::string> known = words_of(kCategoryNames);
  for (const std::string_view floor : kFloorNames) known.emplace_back(floor);
  throw InputError(fmt::format("'{}' is not a category{}", name, hint(name, known)));
}

}  // namespace mh
