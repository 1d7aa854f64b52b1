// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "scenes/generate/generate.hpp"

namespace mh::generate {

Draft draw_shape(const RoomGrammar& grammar, Dice dice, int group) {
  // Large rooms have few objects per area, small rooms have many.
  const double span = grammar.area_m2.high - grammar.area_m2.low;
  constexpr std::array<DrawRange, kDensityGroups> kPart = {
      {{0.55, 1.0}, {0.2, 1.0}, {0.0, 0.85}, {0.0, 0.45}}};
  double area = grammar.area_m2.low + span * draw(dice, kPart[static_cast<std::size_t>(group)]);
  const double aspect = draw(dice, grammar.aspect);
  const bool missing = dice.chance(grammar.cut_chance);
  const double a = draw(dice, grammar.cut_share), b = draw(dice, grammar.cut_share);
  if (missing) area /= 1.0 - a * b;
  double w = whole_mm(std::sqrt(area * aspect)), d = whole_mm(area / w);
  if (dice.chance(0.5)) std::swap(w, d);
  const double height = whole_mm(draw(dice, grammar.height_m));
  std::optional<FloorRect> cut;
  constexpr double kLeft_m = 1.2, kLeast_m = 0.4;  // shortest wall beside the cut, smallest cut
  const double cw = whole_mm(std::min(a * w, w - kLeft_m));
  const double cd = whole_mm(std::min(b * d, d - kLeft_m));
  if (missing && cw > kLeast_m && cd > kLeast_m) {
    const bool south = dice.chance(0.5), west = dice.chance(0.5);
    cut = FloorRect{west ? 0 : w - cw, south ? 0 : d - cd, west ? cw : w, south ? cd : d};
  }
  return {.grammar = grammar, .dice = dice, .group = group, .layout = {w, d, height, cut}};
}

const WallRun& any_outer_wall(Draft& draft) {
  std::vector<const WallRun*> outer;
  for (const WallRun& wall : draft.layout.walls())
    if (wall.outer) outer.push_back(&wall);
  return *outer[draft.dice.below(outer.size())];
}

bool add_door(Draft& draft, const WallRun& wall, const std::string& name, double width_m) {
  Dice& dice = draft.dice;
  if (wall.to_m - wall.from_m < width_m + 0.3) return false;
  // Doors are mostly near a corner.
  double from = dice.number(wall.from_m + 0.13, wall.to_m - 0.13 - width_m);
  if (dice.chance(0.6)) from = dice.chance(0.5) ? wall.from_m + 0.2 : wall.to_m - 0.2 - width_m;
  from = whole_mm(from);
  return draft.layout.add_opening(wall, {.name = name,
                                         .from_m = from,
                                         .to_m = whole_mm(from + width_m),
                                         .low_m = 0,
                                         .high_m = whole_mm(dice.number(2.0, 2.1)),
                                         .door = true});
}

bool add_doors(Draft& draft) {
  Dice& dice = draft.dice;
  const int count = draw_count(dice, draft.grammar.doors);
  for (int i = 0; i < count; ++i) {
    bool placed = false;
    for (int t = 0; t < kTries && !placed; ++t) {
      const WallRun& wall = any_outer_wall(draft);
      const double width = whole_mm(dice.number(0.8, 0.95));
      placed = add_door(draft, wall, fmt::format("door_{}", i + 1), width);
    }
    if (!placed && i == 0) return false;
  }
  return true;
}

void add_windows(Draft& draft) {
  Dice& dice = draft.dice;
  const int count = draw_count(dice, draft.grammar.windows);
  const Side main_side = any_outer_wall(draft).side;
  for (int i = 0; i < count; ++i)
    for (int t = 0; t < kTries; ++t) {
      const WallRun& wall = dice.chance(0.7)
                                ? draft.layout.walls()[static_cast<std::size_t>(main_side)]
                                : any_outer_wall(draft);
      const double width = whole_mm(draw(dice, draft.grammar.window_width_m));
      const double low = whole_mm(draw(dice, draft.grammar.window_sill_m));
      const double high =
          whole_mm(std::min(std::max(low + 0.35, draw(dice, draft.grammar.window_head_m)),
                            draft.layout.height_m() - 0.12));
      if (wall.to_m - wall.from_m < width + 0.3) continue;
      const double from = whole_mm(dice.number(wall.from_m + 0.13, wall.to_m - 0.13 - width));
      if (draft.layout.add_opening(wall, {.name = fmt::format("window_{}", i + 1),
                                          .from_m = from,
                                          .to_m = whole_mm(from + width),
                                          .low_m = low,
                                          .high_m = high}))
        break;
    }
}

}  // namespace mh::generate
