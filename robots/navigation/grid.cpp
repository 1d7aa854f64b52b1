// SPDX-License-Identifier: Apache-2.0
#include "robots/navigation/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace mh {
namespace {

using Eigen::Vector2d;

/// One line of a squared distance transform: f[i] becomes the least f[j] + (i - j)^2.
/// Felzenszwalb and Huttenlocher, "Distance transforms of sampled functions", 2012: the lower
/// envelope of parabolas.
void transform_line(std::vector<double>& f) {
  const auto n = static_cast<int>(f.size());
  std::vector<int> apex;
  std::vector<double> from;  // where each parabola begins to be the lowest
  for (int q = 0; q < n; ++q) {
    if (std::isinf(f[static_cast<std::size_t>(q)])) continue;
    double begin = -std::numeric_limits<double>::infinity();
    while (!apex.empty()) {
      const int v = apex.back();
      begin = (f[static_cast<std::size_t>(q)] + q * q - f[static_cast<std::size_t>(v)] - v * v) /
              (2.0 * (q - v));
      if (begin > from.back()) break;
      apex.pop_back();
      from.pop_back();
      begin = -std::numeric_limits<double>::infinity();
    }
    apex.push_back(q);
    from.push_back(begin);
  }
  if (apex.empty()) return;
  std::vector<double> result(f.size());
  std::size_t k = 0;
  for (int q = 0; q < n; ++q) {
    while (k + 1 < apex.size() && from[k + 1] < q) ++k;
    const double away = q - apex[k];
    result[static_cast<std::size_t>(q)] = f[static_cast<std::size_t>(apex[k])] + away * away;
  }
  f = std::move(result);
}

}  // namespace

std::optional<FloorGrid::Cell> FloorGrid::cell_of(const Vector2d& place_m) const {
  const Vector2d p = (place_m - origin_m) / resolution_m;
  if (!(p.array() > -0.5).all() || p.x() >= clearance_m.width() - 0.5 ||
      p.y() >= clearance_m.height() - 0.5)
    return std::nullopt;
  return Cell{static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

double FloorGrid::clearance_at(const Vector2d& place_m) const {
  const auto cell = cell_of(place_m);
  return cell ? static_cast<double>(clearance_m(cell->first, cell->second)) : 0.0;
}

bool FloorGrid::clear_line(const Vector2d& from_m, const Vector2d& to_m, double clearance) const {
  const auto steps = static_cast<int>(std::ceil((to_m - from_m).norm() / (0.5 * resolution_m))) + 1;
  for (int i = 0; i <= steps; ++i)
    if (clearance_at(from_m + (to_m - from_m) * (static_cast<double>(i) / steps)) < clearance)
      return false;
  return true;
}

Grid2d<std::uint8_t> largest_region(const FloorGrid& grid, double clearance_m) {
  const int w = grid.clearance_m.width(), h = grid.clearance_m.height();
  Grid2d<int> region(w, h);
  std::vector<FloorGrid::Cell> stack;
  int count = 0, best = 0;
  std::size_t best_size = 0;
  const auto open = [&](int x, int y) {
    return region.contains(x, y) && region(x, y) == 0 &&
           static_cast<double>(grid.clearance_m(x, y)) >= clearance_m;
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (!open(x, y)) continue;
      ++count;
      std::size_t size = 0;
      stack.push_back({x, y});
      region(x, y) = count;
      while (!stack.empty()) {
        const auto [cx, cy] = stack.back();
        stack.pop_back();
        ++size;
        for (const auto& [nx, ny] : {FloorGrid::Cell{cx + 1, cy}, FloorGrid::Cell{cx - 1, cy},
                                     FloorGrid::Cell{cx, cy + 1}, FloorGrid::Cell{cx, cy - 1}})
          if (open(nx, ny)) {
            region(nx, ny) = count;
            stack.push_back({nx, ny});
          }
      }
      if (size > best_size) {
        best_size = size;
        best = count;
      }
    }
  Grid2d<std::uint8_t> result(w, h);
  if (best == 0) return result;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) result(x, y) = region(x, y) == best;
  return result;
}

Grid2d<float> distances(const Grid2d<std::uint8_t>& marked) {
  const int w = marked.width(), h = marked.height();
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Grid2d<double> squared(w, h);
  std::vector<double> line(static_cast<std::size_t>(h));
  for (int x = 0; x < w; ++x) {
    for (int y = 0; y < h; ++y) line[static_cast<std::size_t>(y)] = marked(x, y) ? 0 : kFar;
    transform_line(line);
    for (int y = 0; y < h; ++y) squared(x, y) = line[static_cast<std::size_t>(y)];
  }
  Grid2d<float> result(w, h);
  for (int y = 0; y < h; ++y) {
    std::vector<double> row(squared.row(y).begin(), squared.row(y).end());
    transform_line(row);
    for (int x = 0; x < w; ++x)
      result(x, y) = static_cast<float>(std::sqrt(row[static_cast<std::size_t>(x)]));
  }
  return result;
}

Grid2d<float> clearances_m(const Grid2d<std::uint8_t>& blocked, double resolution_m) {
  const Grid2d<float> away = distances(blocked);
  Grid2d<float> clearance_m(blocked.width(), blocked.height());
  for (int y = 0; y < blocked.height(); ++y)
    for (int x = 0; x < blocked.width(); ++x)
      clearance_m(x, y) = static_cast<float>(
          std::max(0.0, (static_cast<double>(away(x, y)) - 0.71) * resolution_m));
  return clearance_m;
}

FloorGrid floor_grid_of(const Grid2d<std::uint8_t>& blocked, double resolution_m,
                        const Eigen::Vector2d& origin_m) {
  return {.resolution_m = resolution_m,
          .origin_m = origin_m,
          .clearance_m = clearances_m(blocked, resolution_m),
          .occupant = {}};
}

}  // namespace mh
