// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/surfaces.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/generate/shape.hpp"

namespace mh::generate {
namespace {

Stuff draw_stuff(const std::string& palette, Dice& dice) {
  const std::vector<PaletteEntry>& list = palettes().lists.at(palette);
  const PaletteEntry& entry = list[dice.below(list.size())];
  const Rgb8 tone = entry.tones[dice.below(entry.tones.size())];
  const auto near = [&](std::uint8_t v) {
    return static_cast<std::uint8_t>(std::clamp(v + dice.whole(-9, 9), 0, 255));
  };
  const Rgb8 shifted{near(tone.r), near(tone.g), near(tone.b)};
  return {&entry, shifted, draw(dice, entry.variation), {}};
}

/// Creates a material, named after its palette.
std::string make_material_of(Draft& draft, const std::string& palette, const Stuff& stuff) {
  // Two pieces of the same material differ slightly in shade and grain.
  const double shade = draft.dice.number(-0.035, 0.035) * (stuff.made.empty() ? 0.0 : 1.0);
  const auto level = [&](std::uint8_t v) {
    return static_cast<std::uint8_t>(
        std::clamp(static_cast<int>(std::lround(v * (1.0 + shade))), 0, 255));
  };
  draft.materials.push_back(
      {.name = fmt::format("{}_{}", palette, draft.materials.size() + 1),
       .kind = stuff.entry->kind,
       .tone = {level(stuff.tone.r), level(stuff.tone.g), level(stuff.tone.b)},
       .variation = stuff.variation,
       .seed = static_cast<std::uint64_t>(draft.dice.whole(1, 999'999))});
  return draft.materials.back().name;
}

/// Usually the same material as the rest of the room.
std::string choose_material(Draft& draft, const std::string& palette) {
  constexpr std::size_t kPiecesOfOneStuff = 3;
  Dice& dice = draft.dice;
  const auto& fresh = palettes().fresh;
  if (std::ranges::find(fresh, palette) != fresh.end())
    return make_material_of(draft, palette, draw_stuff(palette, dice));
  std::vector<Stuff>& known = draft.stuffs[palette];
  if (known.empty() || (known.size() < 4 && dice.chance(0.2)))
    known.push_back(draw_stuff(palette, dice));
  Stuff& stuff = dice.chance(0.65) ? known.front() : known[dice.below(known.size())];
  if (stuff.made.size() < kPiecesOfOneStuff)
    stuff.made.push_back(make_material_of(draft, palette, stuff));
  return stuff.made[dice.below(stuff.made.size())];
}

std::string choose_surface(Draft& draft, const std::vector<std::string>& lists) {
  const std::string palette = lists[draft.dice.below(lists.size())];
  return make_material_of(draft, palette, draw_stuff(palette, draft.dice));
}

}  // namespace

void choose_surfaces(Draft& draft) {
  const RoomGrammar& grammar = draft.grammar;
  Surfaces& chosen = draft.surfaces;
  chosen.floor = choose_surface(draft, grammar.floors);
  chosen.wall = choose_surface(draft, grammar.walls);
  chosen.ceiling = choose_surface(draft, grammar.ceilings);
  if (draft.dice.chance(grammar.accent_chance)) {
    chosen.accent = choose_surface(draft, grammar.walls);
    chosen.accent_side = any_outer_wall(draft).side;
  }
  chosen.trim = choose_surface(draft, {"trims"});
  chosen.frame = choose_surface(draft, {"trims"});
  chosen.garden = choose_surface(draft, {"gardens"});
}

std::map<std::string, std::string> choose_materials(Draft& draft, const ItemRule& rule,
                                                    const FurnitureKind& kind) {
  std::map<std::string, std::string> chosen;
  std::string_view rest = kind.roles;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    const std::string role(rest.substr(0, end));
    rest.remove_prefix(std::min(rest.size(), end + 1));
    const auto in = [&](const std::map<std::string, std::string>& roles) {
      const auto found = roles.find(role);
      if (found == roles.end()) return false;
      chosen[role] = choose_material(draft, found->second);
      return true;
    };
    if (!in(rule.materials) && !in(draft.grammar.roles)) in(palettes().list_of_role);
  }
  return chosen;
}

}  // namespace mh::generate
