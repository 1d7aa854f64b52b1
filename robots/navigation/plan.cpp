// SPDX-License-Identifier: Apache-2.0
#include "robots/navigation/plan.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <queue>
#include <span>
#include <tuple>
#include <utility>

#include "slam/core/random.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Cell = FloorGrid::Cell;

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr double kNarrowPrice = 2.0;  // a meter at the minimum clearance costs 3 m in the open
constexpr double kPoint_m = 1e-6;     // not even a point passes through blocked cells

/// Shortest paths from the nearest of the `starts`, each step weighted by `price`; stops early at
/// `goal`.
struct Search {
  Grid2d<float> cost;
  Grid2d<std::int32_t> before;  ///< index of the predecessor cell, -1 = none

  template <class Price, class Guess>
  Search(const FloorGrid& grid, std::span<const Cell> starts, std::optional<Cell> goal,
         double clearance_m, Price price, Guess guess)
      : cost(grid.clearance_m.width(), grid.clearance_m.height(), kFar),
        before(grid.clearance_m.width(), grid.clearance_m.height(), -1) {
    const int w = cost.width();
    using Entry = std::tuple<float, float, std::int32_t>;  // estimate, cost, cell: a total order
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (const Cell& start : starts) {
      cost(start.first, start.second) = 0;
      open.emplace(guess(start), 0.0F, start.second * w + start.first);
    }
    while (!open.empty()) {
      const auto [estimate, so_far, index] = open.top();
      open.pop();
      const int x = index % w, y = index / w;
      if (so_far > cost(x, y)) continue;
      if (goal && *goal == Cell{x, y}) return;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int nx = x + dx, ny = y + dy;
          if ((dx == 0 && dy == 0) || !cost.contains(nx, ny)) continue;
          const double room_m = grid.clearance_m(nx, ny);
          if (room_m < clearance_m) continue;
          const double step_m = grid.resolution_m * std::hypot(dx, dy);
          const auto next =
              static_cast<float>(static_cast<double>(so_far) + step_m * price(room_m));
          if (next >= cost(nx, ny)) continue;
          cost(nx, ny) = next;
          before(nx, ny) = index;
          open.emplace(next + guess(Cell{nx, ny}), next, ny * w + nx);
        }
    }
  }
};

/// The free cell nearest to a place, at most a cell and a half away: the place itself may be on the
/// border of the free cells.
std::optional<Cell> free_cell(const FloorGrid& grid, const Vector2d& place_m, double clearance_m) {
  clearance_m = std::max(clearance_m, kPoint_m);
  const auto cell = grid.cell_of(place_m);
  if (!cell) return std::nullopt;
  std::optional<Cell> best;
  double best_m = 1.5 * grid.resolution_m;
  for (int y = cell->second - 1; y <= cell->second + 1; ++y)
    for (int x = cell->first - 1; x <= cell->first + 1; ++x) {
      if (!grid.clearance_m.contains(x, y) ||
          static_cast<double>(grid.clearance_m(x, y)) < clearance_m)
        continue;
      const double away_m = (grid.center_of({x, y}) - place_m).norm();
      if (away_m >= best_m) continue;
      best_m = away_m;
      best = Cell{x, y};
    }
  return best;
}

double narrow_price(double room_m, double clearance_m) {
  return 1 + kNarrowPrice * std::clamp(2 - room_m / clearance_m, 0.0, 1.0);
}

/// Removes corners while the straight line keeps as much clearance as the path that it replaces (or
/// twice the required clearance, if the path has more).
std::vector<Vector2d> straightened(const FloorGrid& grid, const std::vector<Vector2d>& way,
                                   double clearance_m) {
  std::vector<Vector2d> result{way.front()};
  std::size_t here = 0;
  while (here + 1 < way.size()) {
    double room_m = 2 * clearance_m;
    std::size_t next = here + 1;
    for (std::size_t k = here + 1; k < way.size(); ++k) {
      room_m = std::min(room_m, std::max(clearance_m, grid.clearance_at(way[k])));
      if (grid.clear_line(way[here], way[k], room_m)) next = k;
    }
    result.push_back(way[next]);
    here = next;
  }
  return result;
}

}  // namespace

std::optional<std::vector<Vector2d>> plan_way(const FloorGrid& grid, const Vector2d& from_m,
                                              const Vector2d& to_m, double clearance_m) {
  clearance_m = std::max(clearance_m, kPoint_m);
  const auto start = free_cell(grid, from_m, clearance_m);
  const auto goal = free_cell(grid, to_m, clearance_m);
  if (!start || !goal) return std::nullopt;
  const Vector2d goal_m = grid.center_of(*goal);
  const Search search(
      grid, std::span(&*start, 1), goal, clearance_m,
      [&](double room_m) { return narrow_price(room_m, clearance_m); },
      [&](Cell c) { return static_cast<float>(0.999 * (grid.center_of(c) - goal_m).norm()); });
  if (search.cost(goal->first, goal->second) == kFar) return std::nullopt;

  std::vector<Vector2d> way{to_m};
  const int w = search.cost.width();
  for (std::int32_t index = goal->second * w + goal->first; index >= 0;
       index = search.before(index % w, index / w))
    way.push_back(grid.center_of({index % w, index / w}));
  way.back() = from_m;
  std::ranges::reverse(way);
  return straightened(grid, way, clearance_m);
}

Grid2d<float> way_lengths(const FloorGrid& grid, std::span<const Vector2d> from_m,
                          double clearance_m) {
  clearance_m = std::max(clearance_m, kPoint_m);
  std::vector<Cell> starts;
  for (const Vector2d& place_m : from_m)
    if (const auto start = free_cell(grid, place_m, clearance_m)) starts.push_back(*start);
  return Search(
             grid, starts, std::nullopt, clearance_m, [](double) { return 1.0; },
             [](Cell) { return 0.0F; })
      .cost;
}

Grid2d<float> way_lengths(const FloorGrid& grid, const Vector2d& from_m, double clearance_m) {
  return way_lengths(grid, std::span(&from_m, 1), clearance_m);
}

std::vector<Vector2d> spread_places(const FloorGrid& grid, const Grid2d<std::uint8_t>& region,
                                    double apart_m, std::size_t most, std::uint64_t seed) {
  std::vector<Vector2d> cells;
  for (int y = 0; y < region.height(); ++y)
    for (int x = 0; x < region.width(); ++x)
      if (region(x, y) != 0) cells.push_back(grid.center_of({x, y}));
  if (cells.empty() || most == 0) return {};
  std::vector<Vector2d> places{cells[RandomStream(seed).below(0, cells.size())]};
  std::vector<double> nearest_m(cells.size(), std::numeric_limits<double>::infinity());
  while (places.size() < most) {
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      nearest_m[i] = std::min(nearest_m[i], (cells[i] - places.back()).norm());
      if (nearest_m[i] > nearest_m[farthest]) farthest = i;
    }
    if (nearest_m[farthest] < apart_m) break;
    places.push_back(cells[farthest]);
  }
  return places;
}

std::vector<std::vector<double>> lengths_between(const FloorGrid& grid,
                                                 std::span<const Vector2d> places,
                                                 double clearance_m) {
  const std::size_t n = places.size();
  std::vector<std::vector<double>> way_m(n, std::vector<double>(n, 0));
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Grid2d<float> lengths = way_lengths(grid, places[i], clearance_m);
    for (std::size_t j = i + 1; j < n; ++j) {
      const auto cell = free_cell(grid, places[j], clearance_m);
      way_m[i][j] = way_m[j][i] =
          cell ? static_cast<double>(lengths(cell->first, cell->second)) : kFar;
    }
  }
  return way_m;
}

RoundTrip round_trip(const std::vector<std::vector<double>>& way_m, std::size_t count) {
  assert(count <= way_m.size());
  if (count == 0) return {};
  std::vector<std::size_t> order{0};
  std::vector<bool> visited(count, false);
  visited[0] = true;
  while (order.size() < count) {
    std::size_t next = count;
    for (std::size_t j = 0; j < count; ++j)
      if (!visited[j] && (next == count || way_m[order.back()][j] < way_m[order.back()][next]))
        next = j;
    visited[next] = true;
    order.push_back(next);
  }
  for (bool shorter = true; shorter;) {
    shorter = false;
    for (std::size_t i = 1; i + 1 < count; ++i)
      for (std::size_t k = i + 1; k < count; ++k) {
        const std::size_t a = order[i - 1], b = order[i], c = order[k], d = order[(k + 1) % count];
        if (!(way_m[a][c] + way_m[b][d] < way_m[a][b] + way_m[c][d] - 1e-6)) continue;
        std::reverse(order.begin() + static_cast<std::ptrdiff_t>(i),
                     order.begin() + static_cast<std::ptrdiff_t>(k) + 1);
        shorter = true;
      }
  }
  RoundTrip trip{.order = std::move(order)};
  for (std::size_t i = 0; i < count; ++i)
    trip.length_m += way_m[trip.order[i]][trip.order[(i + 1) % count]];
  return trip;
}

}  // namespace mh
