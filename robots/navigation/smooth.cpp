// SPDX-License-Identifier: Apache-2.0
#include "robots/navigation/smooth.hpp"

#include <algorithm>
#include <cmath>

namespace mh {
namespace {

constexpr int kRounds = 60;
constexpr double kPull = 0.5;  // step of a sample: share of the way to its neighbors' midpoint

}  // namespace

double length_m(const std::vector<Eigen::Vector2d>& way) {
  double sum_m = 0;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) sum_m += (way[i + 1] - way[i]).norm();
  return sum_m;
}

std::vector<Eigen::Vector2d> smoothed(const FloorGrid& grid,
                                      const std::vector<Eigen::Vector2d>& way, double clearance_m,
                                      double spacing_m) {
  if (way.size() < 2) return way;
  std::vector<Eigen::Vector2d> path{way.front()};
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const int steps = std::max(
        1, static_cast<int>(std::ceil((way[i + 1] - way[i]).norm() / std::max(1e-3, spacing_m))));
    for (int k = 1; k <= steps; ++k)
      path.push_back(way[i] + (way[i + 1] - way[i]) * (static_cast<double>(k) / steps));
  }
  std::vector<double> room_m;
  for (const Eigen::Vector2d& p : path)
    room_m.push_back(std::min(grid.clearance_at(p), std::max(clearance_m, 2 * clearance_m)));
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t i = 1; i + 1 < path.size(); ++i) {
      const Eigen::Vector2d moved = path[i] + kPull * (0.5 * (path[i - 1] + path[i + 1]) - path[i]);
      if (grid.clearance_at(moved) >= std::max(room_m[i], clearance_m)) path[i] = moved;
    }
  return path;
}

}  // namespace mh
