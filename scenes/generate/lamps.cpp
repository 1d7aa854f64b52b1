// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/lamps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/generate/pieces.hpp"

namespace mh::generate {
namespace {

using Eigen::Vector2d;

/// One of the two parts of an L-shaped room next to its missing corner.
struct Arm {
  Vector2d middle_m, end_m;
};
/// The arm west or east of the missing corner, then the arm south or north of it.
std::array<Arm, 2> arms(const FloorRect& room, const FloorRect& cut) {
  const double x = 0.5 * (cut.x0 > room.x0 ? room.x0 + cut.x0 : cut.x1 + room.x1),
               y = 0.5 * (cut.y0 > room.y0 ? room.y0 + cut.y0 : cut.y1 + room.y1);
  return {{{{x, 0.5 * (cut.y0 + cut.y1)}, {x, cut.y0 > room.y0 ? room.y1 : room.y0}},
           {{0.5 * (cut.x0 + cut.x1), y}, {cut.x0 > room.x0 ? room.x1 : room.x0, y}}}};
}

/// If a position is in an arm next to the room's missing corner, moves it to the arm's center line.
Vector2d beside_cut(const Layout& layout, const Vector2d& at_m) {
  if (!layout.cut()) return at_m;
  const FloorRect& cut = *layout.cut();
  const bool beside_x = at_m.y() > cut.y0 && at_m.y() < cut.y1;
  const bool beside_y = at_m.x() > cut.x0 && at_m.x() < cut.x1;
  if (beside_x == beside_y) return at_m;  // in neither arm, or in the corner itself
  if (beside_x) return {arms(layout.rect(), cut)[0].middle_m.x(), at_m.y()};
  return {at_m.x(), arms(layout.rect(), cut)[1].middle_m.y()};
}

/// Whether a lamp illuminates a position directly, not around a corner.
bool is_lit(const Layout& layout, const Vector2d& at_m) {
  constexpr double kFar_m = 4.0;
  constexpr int kSteps = 50;
  return std::ranges::any_of(layout.items(), [&](const LayoutItem& item) {
    if (!item.glow) return false;
    const Vector2d way = item.at_m - at_m;
    for (int k = 0; layout.cut() && k <= kSteps; ++k)
      if (layout.cut()->contains(at_m + way * k / kSteps)) return false;
    return way.norm() < kFar_m;
  });
}

}  // namespace

bool add_lamps(Draft& draft) {
  const Layout& layout = draft.layout;
  const RoomGrammar& grammar = draft.grammar;
  Dice& dice = draft.dice;
  const FloorRect& r = layout.rect();
  const double area = layout.floor_area_m2();
  const int count = std::max(1, static_cast<int>(std::lround(area / grammar.area_per_lamp_m2)));
  const double w = r.x1 - r.x0, d = r.y1 - r.y0;
  const int nx = std::max(1, static_cast<int>(std::lround(std::sqrt(count * w / d))));
  const int ny = std::max(1, static_cast<int>(std::lround(static_cast<double>(count) / nx)));
  ItemRule rule;
  rule.kinds = {grammar.lamp};
  rule.place = Place::kCeiling;
  const Design design = make_design(draft, rule);
  const double power = draw(dice, grammar.lamp_power), warm = draw(dice, grammar.warmth);
  const Eigen::Vector3d color(power, power * (1.0 - 0.14 * warm), power * (1.0 - 0.42 * warm));
  const auto hang = [&](const Vector2d& at) {
    LayoutItem item = make_piece(draft, design);
    item.at_m = whole_mm(at);
    item.z_m = whole_mm(layout.height_m() - item.size_m.z());
    item.glow = color;
    return add(draft, item, design).has_value();
  };
  int placed = 0;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Vector2d at(r.x0 + (i + 0.5) * w / nx, r.y0 + (j + 0.5) * d / ny);
      placed += hang(at) || hang(beside_cut(layout, at)) ? 1 : 0;
    }
  if (placed == 0) return false;
  if (layout.cut())
    for (const Arm& arm : arms(r, *layout.cut()))
      if (!is_lit(layout, arm.end_m)) hang(arm.middle_m);
  return true;
}

Daylight draw_daylight(Dice& dice) {
  return {.dusk = dice.chance(0.15),
          .sun_turn_deg = dice.number(0, 360),
          .sun_power = dice.number(8, 17),
          .sky_power = dice.number(4, 10)};
}

}  // namespace mh::generate
