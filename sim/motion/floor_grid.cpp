// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/floor_grid.hpp"

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
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;

constexpr double kFloorReach_m = 0.1;  // extends the floor, which closes gaps of twice this width
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
        fmt::format("{}: has no level floor to stand on: if there is one, set its height with "
                    "floor_z_m (--floor-z)",
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

}  // namespace

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
  grid.clearance_m = clearances_m(blocked, config.resolution_m);
  return grid;
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
