// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/parts.hpp"

#include <algorithm>
#include <vector>

#include "scenes/generate/places.hpp"

namespace mh::generate {
namespace {

using Eigen::Vector2d;

/// Seats around a table: along both long sides, then at its ends.
void add_around(Draft& draft, const Design& design, std::size_t table_index, int count) {
  const LayoutItem table = draft.layout.item(table_index);
  const double w = table.size_m.x(), depth = table.size_m.y();
  const double room = design.size_m.x() + 0.12;
  const int per_side = std::max(1, static_cast<int>((w - 0.1) / room));
  struct Seat {
    Vector2d local;
    double turn;
  };
  std::vector<Seat> seats;
  for (int i = 0; i < per_side; ++i) {
    const double x = (i + 0.5 - 0.5 * per_side) * std::min(w / per_side, 1.6 * room);
    seats.push_back({{x, -0.5 * (depth + design.size_m.y())}, 180.0});
    seats.push_back({{x, 0.5 * (depth + design.size_m.y())}, 0.0});
  }
  for (const double side : {-1.0, 1.0})
    seats.push_back({{side * 0.5 * (w + design.size_m.y()), 0.0}, side * -90.0});
  for (const Seat& seat : seats) {
    if (count <= 0) return;
    const double gap = draw(draft.dice, design.rule->gap_m);
    const double extra = half_degrees(draw(draft.dice, design.rule->turn_deg));
    LayoutItem item = make_piece(draft, design);
    const Vector2d out = seat.local.y() != 0 ? Vector2d(0, seat.local.y() > 0 ? 1 : -1)
                                             : Vector2d(seat.local.x() > 0 ? 1 : -1, 0);
    item.at_m = whole_mm(from_frame(table.at_m, table.turn_deg, seat.local + gap * out));
    item.turn_deg = table.turn_deg + seat.turn + extra;
    if (gap < 0) item.under = table_index;
    if (const auto added = add(draft, item, design)) {
      --count;
      add_parts(draft, *design.rule, *added);
    }
  }
}

}  // namespace

void add_parts(Draft& draft, const ItemRule& owner, std::size_t index) {
  for (const ItemRule& rule : owner.with) {
    const bool wanted = draft.dice.chance(rule.chance);
    if (!rule.need && (!wanted || (full(draft) && !rule.fitting))) continue;
    const int count = draw_count(draft.dice, rule.count);
    const Design common = make_design(draft, rule);
    if (rule.place == Place::kAround) {
      add_around(draft, common, index, count);
      continue;
    }
    for (int i = 0; i < count; ++i) {
      const Design design = design_of_piece(draft, common, i);
      for (int t = 0; t < kTries; ++t) {
        const auto item = put_at_owner(draft, design, index);
        if (!item) continue;
        if (const auto added = add(draft, *item, design)) {
          add_parts(draft, rule, *added);
          break;
        }
      }
    }
  }
}

}  // namespace mh::generate
