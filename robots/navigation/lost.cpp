// SPDX-License-Identifier: Apache-2.0
#include "robots/navigation/lost.hpp"

#include <algorithm>
#include <cmath>

#include "robots/navigation/plan.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr double kEscape_m = 0.5;  // how far away the nearest place with clearance may be

}  // namespace

std::optional<Vector2d> nearest_clear(const FloorGrid& grid, const Vector2d& place_m,
                                      double clearance_m, double reach_m) {
  std::optional<Vector2d> best;
  double best_m = reach_m;
  for (int y = 0; y < grid.clearance_m.height(); ++y)
    for (int x = 0; x < grid.clearance_m.width(); ++x) {
      if (static_cast<double>(grid.clearance_m(x, y)) < clearance_m) continue;
      const double away_m = (grid.center_of({x, y}) - place_m).norm();
      if (away_m >= best_m) continue;
      best_m = away_m;
      best = grid.center_of({x, y});
    }
  return best;
}

std::optional<std::vector<Vector2d>> way_out(const FloorGrid& grid, const Vector2d& from_m,
                                             const Vector2d& to_m, double clearance_m) {
  const auto from = nearest_clear(grid, from_m, clearance_m, kEscape_m);
  if (!from) return std::nullopt;
  auto way = plan_way(grid, *from, to_m, clearance_m);
  if (!way) return std::nullopt;
  if ((*from - from_m).norm() > 0.5 * grid.resolution_m)
    way->insert(way->begin(), from_m);
  else
    way->front() = from_m;
  return way;
}

std::optional<std::vector<Vector2d>> way_to_look_around(const FloorGrid& grid,
                                                        const std::vector<Vector2d>& looked,
                                                        const LostConfig& config) {
  const Vector2d here = looked.back();
  // In tight places, less than the usual clearance has to suffice.
  for (const double clearance_m : {config.clearance_m, 0.9 * config.clearance_m}) {
    const auto start = nearest_clear(grid, here, clearance_m, kEscape_m);
    if (!start) continue;
    const Grid2d<float> lengths = way_lengths(grid, *start, clearance_m);
    std::optional<Vector2d> best;
    double best_m = 0;
    for (int y = 0; y < lengths.height(); ++y)
      for (int x = 0; x < lengths.width(); ++x) {
        const double length_m = static_cast<double>(lengths(x, y));
        if (!(length_m <= config.most_m)) continue;
        const Vector2d place_m = grid.center_of({x, y});
        if ((place_m - here).norm() < config.least_m) continue;
        double nearest_m = std::numeric_limits<double>::infinity();
        for (const Vector2d& before : looked)
          nearest_m = std::min(nearest_m, (place_m - before).norm());
        if (nearest_m <= best_m) continue;
        best_m = nearest_m;
        best = place_m;
      }
    if (!best) continue;
    if (auto way = way_out(grid, here, *best, clearance_m)) return way;
  }
  return std::nullopt;
}

}  // namespace mh
