// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generate.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "scenes/generate/describe.hpp"
#include "scenes/generate/floor.hpp"
#include "scenes/generate/furnish.hpp"
#include "scenes/generate/lamps.hpp"
#include "scenes/generate/shape.hpp"
#include "scenes/generate/surfaces.hpp"
#include "scenes/house/house.hpp"
#include "scenes/name_key.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using namespace generate;

constexpr int kDrafts = 400;         // rooms that are drawn until one is complete
constexpr double kLeastFree = 0.07;  // share of the floor where the robot can stand

int draw_wanted_objects(Dice& dice, int group, double area_m2) {
  constexpr std::array<DrawRange, kDensityGroups> kPer10_m2 = {
      {{1.5, 3.9}, {4.1, 7.9}, {8.2, 15.8}, {16.3, 34.0}}};
  const double ratio = draw(dice, kPer10_m2[static_cast<std::size_t>(group)]);
  return std::max(3, static_cast<int>(ratio * area_m2 / 10.0));
}

/// Furnishes an empty room. @returns whether all required pieces fit
bool furnish(Draft& draft) {
  const RoomGrammar& grammar = draft.grammar;
  if (!add_doors(draft)) return false;
  add_windows(draft);
  choose_surfaces(draft);
  if (!add_lamps(draft)) return false;
  draft.daylight = draw_daylight(draft.dice);
  const double area = draft.layout.floor_area_m2();
  draft.wanted_objects = draw_wanted_objects(draft.dice, draft.group, area);
  for (const ItemRule& rule : grammar.furniture)
    if (!add_by_rule(draft, rule)) return false;
  add_extras(draft);
  draft.fitting = true;
  for (const ItemRule& rule : grammar.fittings) add_by_rule(draft, rule);
  return density_group(10.0 * draft.layout.object_count() / area) == draft.group &&
         draft.layout.free_share() >= kLeastFree;
}

GeneratedPlan plan_of(const Draft& draft, const std::string& name) {
  const Layout& layout = draft.layout;
  return {
      .name = name,
      .room = draft.grammar.name,
      .house = describe(draft, name),
      .floor_area_m2 = layout.floor_area_m2(),
      .objects = layout.object_count(),
      .fittings = static_cast<int>(std::ranges::count(layout.items(), true, &LayoutItem::fitting)),
      .free_share = layout.free_share()};
}

int draw_group(Dice& dice, const std::array<double, 4>& weights) {
  double at = dice.number(0, weights[0] + weights[1] + weights[2] + weights[3]);
  for (int g = 0; g < 3; ++g) {
    if (at < weights[static_cast<std::size_t>(g)]) return g;
    at -= weights[static_cast<std::size_t>(g)];
  }
  return 3;
}

}  // namespace

GeneratedReference parse_generated(std::string_view source) {
  const std::string text(source);
  const std::size_t first = source.find(':'), last = source.rfind(':');
  GeneratedReference reference;
  const bool shaped = source.starts_with(kGeneratedPrefix) && last > first;
  if (shaped) {
    reference.category = source.substr(first + 1, last - first - 1);
    const std::string_view number = source.substr(last + 1);
    const auto [end, error] =
        std::from_chars(number.data(), number.data() + number.size(), reference.seed);
    if (error == std::errc() && end == number.data() + number.size() && !number.empty()) {
      if (floor_by_name(reference.category) == nullptr) category_by_name(reference.category);
      return reference;
    }
  }
  throw InputError(
      fmt::format("'{}' names no generated environment: write generated:CATEGORY:SEED, "
                  "for example generated:bathroom:3",
                  text));
}

std::string to_string(const GeneratedReference& reference) {
  return fmt::format("generated:{}:{}", reference.category, reference.seed);
}

GeneratedPlan generate_plan(const GeneratedReference& reference) {
  if (const FloorGrammar* const floor = floor_by_name(reference.category))
    return generate_floor(*floor, reference.seed);
  const Category& category = category_by_name(reference.category);
  const RandomStream stream = RandomStream(name_key(category.name)).fork(reference.seed);
  const RoomGrammar& room = category.rooms[reference.seed % category.rooms.size()];
  Dice chooser(stream.fork(0));
  const int group = draw_group(chooser, room.density);
  for (std::uint64_t draft = 1; draft <= kDrafts; ++draft) {
    Draft drawn = draw_shape(room, Dice(stream.fork(draft)), group);
    if (furnish(drawn)) return plan_of(drawn, fmt::format("{}-{}", category.name, reference.seed));
  }
  throw MachineError(fmt::format("{}: none of {} drafts had room for what a {} of density {} needs",
                                 to_string(reference), kDrafts, room.name,
                                 density_group_name(group)));
}

std::string with_detail(const GeneratedPlan& plan) {
  HouseFile fine = plan.house;
  fine.detail = 1.0;
  for (int round = 0; round < 4; ++round) {
    const auto count = static_cast<double>(count_triangles(to_yaml(fine), plan.name));
    const double wanted = std::clamp(count, static_cast<double>(kLeastTriangles),
                                     static_cast<double>(kMostTriangles));
    if (wanted == count) break;
    // The number of triangles of round shapes does not scale with detail: aim slightly higher.
    fine.detail = std::clamp(*fine.detail * std::pow(wanted / count, 0.65), 0.5, 6.0);
  }
  return to_yaml(fine);
}

Scene generate_scene(const GeneratedReference& reference) {
  return build_house(with_detail(generate_plan(reference)), to_string(reference));
}

int density_group(double objects_per_10_m2) {
  return objects_per_10_m2 < 4 ? 0 : objects_per_10_m2 < 8 ? 1 : objects_per_10_m2 < 16 ? 2 : 3;
}

std::string_view density_group_name(int group) {
  constexpr std::array<std::string_view, kDensityGroups> kNames = {"0-4", "4-8", "8-16", "16+"};
  return kNames.at(static_cast<std::size_t>(group));
}

}  // namespace mh
