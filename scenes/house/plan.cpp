// SPDX-License-Identifier: Apache-2.0
#include "scenes/house/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mh {

using Eigen::Vector2d;

std::string_view side_name(Side side) {
  constexpr std::array<std::string_view, 4> kNames = {"south", "north", "west", "east"};
  return kNames[static_cast<std::size_t>(side)];
}

double wall_at(const FloorRect& rect, Side side) {
  switch (side) {
    case Side::kSouth:
      return rect.y0;
    case Side::kNorth:
      return rect.y1;
    case Side::kWest:
      return rect.x0;
    case Side::kEast:
      return rect.x1;
  }
  return 0;
}

std::pair<double, double> wall_span(const FloorRect& rect, Side side) {
  return runs_along_x(side) ? std::pair{rect.x0, rect.x1} : std::pair{rect.y0, rect.y1};
}

std::pair<double, double> wall_span(const RoomPlan& room, Side side) {
  auto [low, high] = wall_span(room.rect, side);
  if (!room.cut || wall_at(*room.cut, side) != wall_at(room.rect, side)) return {low, high};
  const auto [cut_low, cut_high] = wall_span(*room.cut, side);
  (cut_low <= low ? low : high) = cut_low <= low ? cut_high : cut_low;
  return {low, high};
}

std::vector<Vector2d> RoomPlan::outline_m() const {
  const FloorRect& r = rect;
  std::vector<Vector2d> corners = {{r.x0, r.y0}, {r.x1, r.y0}, {r.x1, r.y1}, {r.x0, r.y1}};
  if (!cut) return corners;
  const bool south = cut->y0 <= r.y0, west = cut->x0 <= r.x0;
  const std::size_t missing = south ? (west ? 0 : 1) : (west ? 3 : 2);
  // Counter-clockwise: the end of the wall before the missing corner, the inner corner, the start
  // of the next wall.
  const Vector2d inner(west ? cut->x1 : cut->x0, south ? cut->y1 : cut->y0);
  const Vector2d on_x(inner.x(), south ? r.y0 : r.y1), on_y(west ? r.x0 : r.x1, inner.y());
  const bool y_first = south == west;
  const std::array<Vector2d, 3> step = {y_first ? on_y : on_x, inner, y_first ? on_x : on_y};
  corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(missing));
  corners.insert(corners.begin() + static_cast<std::ptrdiff_t>(missing), step.begin(), step.end());
  return corners;
}

std::array<Vector2d, 4> ItemPlan::footprint() const {
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  std::array<Vector2d, 4> result;
  constexpr std::array<std::array<double, 2>, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = kCorners[i][0] * size_m.x() / 2, y = kCorners[i][1] * size_m.y() / 2;
    result[i] = position_m.head<2>() + Vector2d(c * x - s * y, s * x + c * y);
  }
  return result;
}

double overlap_m(const std::array<Vector2d, 4>& a, const std::array<Vector2d, 4>& b) {
  // Separating axes: the least overlap over all edge normals.
  double least = std::numeric_limits<double>::infinity();
  for (const auto* quad : {&a, &b})
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2d edge = (*quad)[(i + 1) % 4] - (*quad)[i];
      const Vector2d normal = Vector2d(edge.y(), -edge.x()).normalized();
      double a_low = 1e30, a_high = -1e30, b_low = 1e30, b_high = -1e30;
      for (std::size_t k = 0; k < 4; ++k) {
        a_low = std::min(a_low, normal.dot(a[k]));
        a_high = std::max(a_high, normal.dot(a[k]));
        b_low = std::min(b_low, normal.dot(b[k]));
        b_high = std::max(b_high, normal.dot(b[k]));
      }
      least = std::min(least, std::min(a_high, b_high) - std::max(a_low, b_low));
    }
  return least;
}

}  // namespace mh
