// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/arrangements.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/generate/parts.hpp"
#include "slam/core/angles.hpp"

namespace mh::generate {
namespace {

using Eigen::Vector2d;

/// Adds one piece of a pattern, with its parts; `local` is in a frame at the room's middle.
bool add_in_frame(Draft& draft, const Design& d, const Vector2d& local, double frame_deg,
                  double turn_deg) {
  const FloorRect& r = draft.layout.rect();
  const Vector2d middle(0.5 * (r.x0 + r.x1), 0.5 * (r.y0 + r.y1));
  LayoutItem item = make_piece(draft, d);
  item.at_m = whole_mm(from_frame(middle, frame_deg, local));
  item.turn_deg = turn_deg + half_degrees(draw(draft.dice, d.rule->turn_deg));
  const auto added = add(draft, item, d);
  if (added) add_parts(draft, *d.rule, *added);
  return added.has_value();
}

}  // namespace

int add_rows(Draft& draft, const Design& d) {
  Dice& dice = draft.dice;
  const FloorRect& r = draft.layout.rect();
  double turn = 90.0 * dice.whole(0, 3);
  for (const LayoutItem& item : draft.layout.items())  // toward the whiteboard
    if (item.kind->class_name == "whiteboard") turn = item.turn_deg;
  const bool swapped = std::abs(std::sin(turn * kDegree)) > 0.5;
  const double wide = swapped ? r.y1 - r.y0 : r.x1 - r.x0;
  const double deep = swapped ? r.x1 - r.x0 : r.y1 - r.y0;
  const double aisle = draw(dice, d.rule->gap_m), way = draw(dice, d.rule->spacing_m);
  const double margin = 0.75, before = 1.7, behind = 0.3;
  const int columns =
      std::max(1, static_cast<int>((wide - 2 * margin + aisle) / (d.size_m.x() + aisle)));
  const int lines = std::max(1, static_cast<int>((deep - before - behind) / (d.size_m.y() + way)));
  const int wanted = draw_count(dice, d.rule->count);
  int placed = 0;
  for (int j = 0; j < lines && placed < wanted; ++j)
    for (int i = 0; i < columns && placed < wanted; ++i) {
      const Vector2d local((i + 0.5 - 0.5 * columns) * (d.size_m.x() + aisle),
                           0.5 * deep - before - j * (d.size_m.y() + way) - 0.5 * d.size_m.y());
      placed += add_in_frame(draft, d, local, turn, turn) ? 1 : 0;
    }
  return placed;
}

int add_aisles(Draft& draft, const Design& d) {
  Dice& dice = draft.dice;
  const FloorRect& r = draft.layout.rect();
  const bool along_y = dice.chance(0.5);
  const double wide = along_y ? r.y1 - r.y0 : r.x1 - r.x0;  // along a row
  const double deep = along_y ? r.x1 - r.x0 : r.y1 - r.y0;
  const double turn = along_y ? 90.0 : 0.0;
  const double way = draw(dice, d.rule->spacing_m), w = d.size_m.x(), depth = d.size_m.y();
  const double end = 0.85, pitch = 2 * depth + 0.02 + way;
  const int lines = static_cast<int>((deep - 2 * (depth + way) + way) / pitch);
  const int per_line = static_cast<int>((wide - 2 * end) / (w + 0.01));
  const int wanted = draw_count(dice, d.rule->count);
  int placed = 0;
  for (int j = 0; j < lines; ++j)
    for (int i = 0; i < per_line && placed < wanted; ++i)
      for (const double side : {-1.0, 1.0}) {
        const Vector2d local((i + 0.5 - 0.5 * per_line) * (w + 0.01),
                             (j + 0.5 - 0.5 * lines) * pitch + side * (0.5 * depth + 0.005));
        placed += add_in_frame(draft, d, local, turn, turn + (side < 0 ? 0.0 : 180.0)) ? 1 : 0;
      }
  return placed;
}

void add_at_windows(Draft& draft, const Design& common) {
  Dice& dice = draft.dice;
  for (const WallOpening& window : std::vector(draft.layout.openings())) {
    if (window.door) continue;
    const WallRun& wall = draft.layout.walls()[static_cast<std::size_t>(window.side)];
    const double middle = 0.5 * (window.from_m + window.to_m);
    Design d = common;
    std::vector<double> places{middle};
    double z = 0;
    if (d.kind->name == "curtain") {
      z = 0.02;
      d.size_m.z() = std::min(window.high_m + 0.14, draft.layout.height_m() - 0.02) - z;
      const double half = 0.5 * (window.to_m - window.from_m + d.size_m.x()) + 0.02;
      places = {middle - half, middle + half};
    } else if (d.kind->name == "radiator") {
      d.size_m.x() = whole_mm(0.85 * (window.to_m - window.from_m));
      d.size_m.z() = std::min(d.size_m.z(), window.low_m - 0.15);
      if (d.size_m.z() < 0.25) continue;
      z = 0.08;
    } else {  // blinds
      d.size_m.x() = window.to_m - window.from_m;
      d.size_m.z() = (window.high_m - window.low_m) * dice.number(0.25, 0.9);
      z = window.high_m + 0.05 - d.size_m.z();
    }
    for (int k = 0; k < 3; ++k) d.size_m[k] = whole_mm(d.size_m[k]);
    for (const double along : places) {
      LayoutItem item = make_piece(draft, d);
      item.at_m =
          whole_mm(wall.place(along, d.size_m.y(), d.kind->mount == Mount::kWall ? 0.002 : 0.02));
      item.turn_deg = wall.turn_deg();
      item.z_m = whole_mm(z);
      item.covers_window = d.kind->name == "blinds";
      if (const auto added = add(draft, item, d)) add_parts(draft, *d.rule, *added);
    }
  }
}

void add_at_doors(Draft& draft, const Design& d) {
  Dice& dice = draft.dice;
  constexpr double kFrame_m = 0.1;
  for (const WallOpening& door : std::vector(draft.layout.openings())) {
    if (!door.door) continue;
    const WallRun& wall = draft.layout.walls()[static_cast<std::size_t>(door.side)];
    const double gap = kFrame_m + draw(dice, d.rule->gap_m), half = 0.5 * d.size_m.x();
    const bool before = dice.chance(0.5);
    for (const bool low : {before, !before}) {
      LayoutItem item = make_piece(draft, d);
      item.at_m = whole_mm(
          wall.place(low ? door.from_m - gap - half : door.to_m + gap + half, d.size_m.y(), 0.002));
      item.turn_deg = wall.turn_deg();
      item.z_m = d.rule->z_m ? whole_mm(draw(dice, *d.rule->z_m)) : 0.0;
      if (add(draft, item, d)) break;
    }
  }
}

void add_along_wall(Draft& draft, const Design& common) {
  Dice& dice = draft.dice;
  constexpr double kStep_m = 0.05, kLeast_m = 0.3, kCorner_m = 0.03;
  const WallRun& wall = draft.layout.walls()[dice.below(draft.layout.walls().size())];
  Design d = common;
  const double z = common.rule->z_m ? common.rule->z_m->low : 0.0;
  for (double from = wall.from_m + kCorner_m; from + kLeast_m < wall.to_m;) {
    double to = wall.to_m - kCorner_m;
    bool placed = false;
    for (; !placed && to - from >= kLeast_m; to -= kStep_m) {
      d.size_m.x() = whole_mm(std::min(to - from, common.size_m.x()));
      LayoutItem item = make_piece(draft, d);
      item.at_m = whole_mm(wall.place(from + 0.5 * d.size_m.x(), d.size_m.y(), 0.002));
      item.turn_deg = wall.turn_deg();
      item.z_m = whole_mm(z);
      placed = add(draft, item, d).has_value();
    }
    from += placed ? d.size_m.x() + 0.006 : kStep_m;
  }
}

}  // namespace mh::generate
