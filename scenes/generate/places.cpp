// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/places.hpp"
#include "slam/core/angles.hpp"

#include <algorithm>
#include <cmath>

namespace mh::generate {
namespace {

using Eigen::Vector2d;

/// Width and depth of the axis-aligned rectangle around a rotated rectangle.
Vector2d turned_size(const Eigen::Vector3d& size_m, double turn_deg) {
  const double c = std::abs(std::cos(turn_deg * kDegree)),
               s = std::abs(std::sin(turn_deg * kDegree));
  return {c * size_m.x() + s * size_m.y(), s * size_m.x() + c * size_m.y()};
}

bool put_at_wall(Draft& draft, const ItemRule& rule, double extra_deg, LayoutItem& item) {
  Dice& dice = draft.dice;
  const WallRun& wall = draft.layout.walls()[dice.below(draft.layout.walls().size())];
  const Vector2d size = turned_size(item.size_m, extra_deg);
  const double low = wall.from_m + size.x() / 2 + 0.02, high = wall.to_m - size.x() / 2 - 0.02;
  if (high < low) return false;
  double along = dice.number(low, high);
  if (rule.place == Place::kCorner) along = dice.chance(0.5) ? low : high;
  // Furniture often stands right at the end of a wall, without a small gap.
  if (rule.place == Place::kWall && dice.chance(0.35)) along = dice.chance(0.5) ? low : high;
  const double gap = rule.place == Place::kHang ? 0.002 : draw(dice, rule.gap_m);
  item.at_m = wall.place(along, size.y(), gap);
  item.turn_deg = wall.turn_deg() + extra_deg;
  item.z_m = rule.z_m ? whole_mm(draw(dice, *rule.z_m)) : 0.0;
  return true;
}

/// Places a piece near the middle of the room, with its longer side along the room's longer side.
void put_in_center(Draft& draft, double extra_deg, LayoutItem& item) {
  Dice& dice = draft.dice;
  const FloorRect& r = draft.layout.rect();
  item.at_m = {0.5 * (r.x0 + r.x1) * dice.number(0.8, 1.2),
               0.5 * (r.y0 + r.y1) * dice.number(0.8, 1.2)};
  const bool along_x = r.x1 - r.x0 > r.y1 - r.y0;
  item.turn_deg = (along_x == (item.size_m.x() > item.size_m.y()) ? 0.0 : 90.0) +
                  (dice.chance(0.5) ? 180.0 : 0.0);
  item.turn_deg += extra_deg;
}

Vector2d anywhere(Draft& draft) {
  const FloorRect& r = draft.layout.rect();
  return {draft.dice.number(r.x0, r.x1), draft.dice.number(r.y0, r.y1)};
}

/// Places a piece on a carrier, within the rule's zone.
bool put_on(Draft& draft, const ItemRule& rule, std::size_t carrier_index, LayoutItem& item) {
  const LayoutItem& carrier = draft.layout.item(carrier_index);
  item.on_turn_deg = half_degrees(draw(draft.dice, rule.turn_deg));
  const Vector2d half = 0.5 * turned_size(item.size_m, item.on_turn_deg);
  const Vector2d own = 0.5 * carrier.size_m.head<2>();
  Vector2d low(rule.zone[0] * own.x(), rule.zone[1] * own.y());
  Vector2d high(rule.zone[2] * own.x(), rule.zone[3] * own.y());
  low += half, high -= half;
  constexpr double kOver_m = 0.02;  // overhang of things at the edge
  for (int k = 0; k < 2; ++k) {
    if (high[k] < low[k] - kOver_m) return false;
    if (high[k] < low[k]) low[k] = high[k] = 0.5 * (low[k] + high[k]);
    item.on_at_m[k] = whole_mm(draft.dice.number(low[k], high[k]));
  }
  item.on = carrier_index;
  item.on_board = rule.z_m.has_value();
  const double up = rule.z_m ? whole_mm(draw(draft.dice, *rule.z_m)) : carrier.size_m.z();
  item.z_m = carrier.z_m + up;
  item.at_m = from_frame(carrier.at_m, carrier.turn_deg, item.on_at_m);
  item.turn_deg = carrier.turn_deg + item.on_turn_deg;
  return true;
}

bool put_on_any(Draft& draft, const ItemRule& rule, LayoutItem& item) {
  std::vector<std::size_t> carriers;
  for (std::size_t i = 0; i < draft.layout.items().size(); ++i)
    if (std::ranges::find(rule.carriers, draft.layout.item(i).kind->name) != rule.carriers.end())
      carriers.push_back(i);
  return !carriers.empty() &&
         put_on(draft, rule, carriers[draft.dice.below(carriers.size())], item);
}

bool put(Draft& draft, const ItemRule& rule, LayoutItem& item) {
  const double extra_deg = half_degrees(draw(draft.dice, rule.turn_deg));
  switch (rule.place) {
    case Place::kWall:
    case Place::kHang:
    case Place::kCorner:
      return put_at_wall(draft, rule, extra_deg, item);
    case Place::kCenter:
      put_in_center(draft, extra_deg, item);
      return true;
    case Place::kFloor:
      item.at_m = anywhere(draft);
      item.turn_deg = extra_deg != 0 ? extra_deg : 90.0 * draft.dice.whole(0, 3);
      return true;
    case Place::kCeiling:
      item.at_m = anywhere(draft);
      item.z_m = draft.layout.height_m() - item.size_m.z();
      return true;
    case Place::kOnAny:
      return put_on_any(draft, rule, item);
    default:
      return false;
  }
}

}  // namespace

std::optional<LayoutItem> put_in_room(Draft& draft, const Design& design) {
  LayoutItem item = make_piece(draft, design);
  if (!put(draft, *design.rule, item)) return std::nullopt;
  item.at_m = whole_mm(item.at_m);
  return item;
}

std::optional<LayoutItem> put_at_owner(Draft& draft, const Design& design,
                                       std::size_t owner_index) {
  Dice& dice = draft.dice;
  LayoutItem item = make_piece(draft, design);
  const LayoutItem& owner = draft.layout.item(owner_index);
  const ItemRule& rule = *design.rule;
  if (rule.place == Place::kOn) {
    if (!put_on(draft, rule, owner_index, item)) return std::nullopt;
    return item;
  }
  const double gap = draw(dice, rule.gap_m);
  const double extra = half_degrees(draw(dice, rule.turn_deg));
  Vector2d local = Vector2d::Zero();
  double turn = 0;
  if (rule.z_m) item.z_m = whole_mm(draw(dice, *rule.z_m));
  const double slack = dice.number(rule.zone[0], rule.zone[2]);  // sideways, in owner's half widths
  switch (rule.place) {
    case Place::kBeside: {
      const double side = dice.chance(0.5) ? 1.0 : -1.0;
      local.x() = side * (0.5 * (owner.size_m.x() + item.size_m.x()) + gap);
      local.y() = 0.5 * (owner.size_m.y() - item.size_m.y());  // so that their backs are flush
      break;
    }
    case Place::kFront:  // faces its owner, as a chair faces a desk
      local.y() = -(0.5 * (owner.size_m.y() + item.size_m.y()) + gap);
      local.x() = rule.zone[0] <= -1 ? 0.0 : slack * 0.5 * owner.size_m.x();
      turn = 180.0;
      break;
    case Place::kAbove:
      local.y() = 0.5 * (owner.size_m.y() - item.size_m.y());
      local.x() = rule.zone[0] <= -1 ? 0.0 : slack * 0.5 * owner.size_m.x();
      if (!rule.z_m) item.z_m = whole_mm(owner.z_m + owner.size_m.z() + 0.3);
      break;
    default:
      return std::nullopt;
  }
  if (rule.place == Place::kFront && gap < 0) item.under = owner_index;
  item.turn_deg = owner.turn_deg + turn + extra;
  item.at_m = whole_mm(from_frame(owner.at_m, owner.turn_deg, local));
  return item;
}

}  // namespace mh::generate
