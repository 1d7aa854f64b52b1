// SPDX-License-Identifier: Apache-2.0
#include "robots/navigation/floor_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "scenes/band.hpp"
#include "scenes/floor.hpp"
#include "slam/core/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;

constexpr double kFloorReach_m = 0.1;  // floor is extended this far: closes gaps of twice it
constexpr double kLevel = 0.85;        // cosine of the slope up to which a face is floor
constexpr int kMostCells = 4096;

bool is_floor(const Scene& scene, std::size_t face, const std::array<Vector3f, 3>& p) {
  const double highest_m =
      is_walked_on(scene.class_of[face]) ? kHighestFloor_m : scene.floor.rough_m;
  for (const Vector3f& corner : p)
    if (corner.z() > static_cast<float>(highest_m) ||
        corner.z() < -static_cast<float>(kDeepestFloor_m))
      return false;
  const Eigen::Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]).cast<double>();
  return std::abs(n.z()) >= kLevel * n.norm() && n.norm() > 0;
}

std::array<Vector3f, 3> corners(const Scene& scene, std::size_t face) {
  const auto& [a, b, c] = scene.triangles[face];
  return {scene.positions_m[a], scene.positions_m[b], scene.positions_m[c]};
}

struct Bounds {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
  Vector2d high = -low;
  void include(const Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

Bounds floor_bounds(const Scene& scene) {
  Bounds floor, rooms;
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    const auto p = corners(scene, face);
    if (!is_floor(scene, face, p)) continue;
    for (const Vector3f& corner : p) floor.include(corner.head<2>().cast<double>());
  }
  if (!(floor.low.array() < floor.high.array()).all())
    throw InputError(
        fmt::format("{}: has no level floor to stand on: if there is one, tell its "
                    "height by floor_z_m (--floor-z)",
                    scene.name));
  for (const Room& room : scene.rooms)
    for (const Vector2d& corner : room.polygon_m) rooms.include(corner);
  if (scene.rooms.empty()) return floor;
  return {floor.low.cwiseMax(rooms.low), floor.high.cwiseMin(rooms.high)};
}

/// Calls visit(x, y) for every cell that a convex polygon, seen from above, touches: a
/// separating-axis test with the cell's axes and the normals of the polygon's sides.
template <class Visit>
void for_each_cell(const FloorGrid& grid, std::span<const Vector3f> polygon, Visit visit) {
  std::vector<Vector2d> p;  // in cells: cell (x, y) covers [x - 1/2, x + 1/2]
  Bounds bounds;
  for (const Vector3f& corner : polygon) {
    p.push_back((corner.head<2>().cast<double>() - grid.origin_m) / grid.resolution_m);
    bounds.include(p.back());
  }
  const auto first = [](double v) { return static_cast<int>(std::ceil(v - 0.5)); };
  const auto last = [](double v) { return static_cast<int>(std::floor(v + 0.5)); };
  if ((bounds.high.array() < -1).any() || bounds.low.x() > grid.clearance_m.width() ||
      bounds.low.y() > grid.clearance_m.height())
    return;
  const int x0 = std::max(0, first(bounds.low.x())), y0 = std::max(0, first(bounds.low.y()));
  const int x1 = std::min(grid.clearance_m.width() - 1, last(bounds.high.x()));
  const int y1 = std::min(grid.clearance_m.height() - 1, last(bounds.high.y()));
  const auto apart = [&p](const Vector2d& center) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vector2d side = p[(i + 1) % p.size()] - p[i];
      const Vector2d normal(-side.y(), side.x());
      const double reach = 0.5 * (std::abs(normal.x()) + std::abs(normal.y()));
      const double middle = normal.dot(center);
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Vector2d& q : p) {
        low = std::min(low, normal.dot(q));
        high = std::max(high, normal.dot(q));
      }
      if (low > middle + reach || high < middle - reach) return true;
    }
    return false;
  };
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      if (!apart({x, y})) visit(x, y);
}

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

/// Distance (cells) from each cell's center to that of the nearest marked one; infinite if there is
/// none.
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

FloorGrid make_floor_grid(const Scene& scene, const FloorGridConfig& config) {
  if (!(config.resolution_m >= 0.005 && config.resolution_m <= 1.0))
    throw InputError(
        fmt::format("floor grid: resolution_m: {} is outside 0.005 to 1", config.resolution_m));
  FloorGrid grid;
  grid.resolution_m = config.resolution_m;
  const Bounds bounds = floor_bounds(scene);
  const double margin_m = 2 * config.resolution_m;  // the edge of the floor is inside the grid
  grid.origin_m = bounds.low.array() - margin_m;
  const Vector2d cells = (bounds.high - bounds.low) / config.resolution_m;
  if (cells.maxCoeff() > kMostCells)
    throw InputError(fmt::format("{}: its floor of {:.0f} x {:.0f} m is too large to plan on",
                                 scene.name, bounds.high.x() - bounds.low.x(),
                                 bounds.high.y() - bounds.low.y()));
  const int w = static_cast<int>(std::ceil(cells.x())) + 5;
  const int h = static_cast<int>(std::ceil(cells.y())) + 5;
  grid.clearance_m = Grid2d<float>(w, h);
  grid.occupant = Grid2d<InstanceId>(w, h);

  Grid2d<std::uint8_t> floor(w, h), blocked(w, h);
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    const auto p = corners(scene, face);
    if (is_floor(scene, face, p)) for_each_cell(grid, p, [&](int x, int y) { floor(x, y) = 1; });
  }
  const Grid2d<float> to_floor = distances(floor);
  const auto inside = [&](int x, int y) {
    const Vector2d p = grid.center_of({x, y});
    return (p.array() >= bounds.low.array()).all() && (p.array() <= bounds.high.array()).all();
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      blocked(x, y) = to_floor(x, y) * config.resolution_m > kFloorReach_m || !inside(x, y);
  for_each_face_in_band(scene, static_cast<float>(config.bottom_m.value_or(scene.floor.rough_m)),
                        static_cast<float>(config.top_m),
                        [&](std::size_t face, std::span<const Vector3f> polygon) {
                          for_each_cell(grid, polygon, [&](int x, int y) {
                            blocked(x, y) = 1;
                            grid.occupant(x, y) = scene.instance_of[face];
                          });
                        });
  // A cell is blocked where anything touches it, so the obstacle may be up to half a diagonal
  // closer than the cell's center.
  const Grid2d<float> away = distances(blocked);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      grid.clearance_m(x, y) = static_cast<float>(
          std::max(0.0, (static_cast<double>(away(x, y)) - 0.71) * config.resolution_m));
  return grid;
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

std::string occupant_near(const FloorGrid& grid, const Scene& scene, const Vector2d& place_m,
                          double reach_m) {
  InstanceId nearest = 0;
  double nearest_m = reach_m;
  for (int y = 0; y < grid.occupant.height(); ++y)
    for (int x = 0; x < grid.occupant.width(); ++x) {
      const double away_m = (grid.center_of({x, y}) - place_m).norm();
      if (grid.occupant(x, y) == 0 || away_m > nearest_m) continue;
      nearest_m = away_m;
      nearest = grid.occupant(x, y);
    }
  for (const Instance& instance : scene.instances)
    if (nearest != 0 && instance.id == nearest) return " against " + instance.name;
  return "";
}

}  // namespace mh
