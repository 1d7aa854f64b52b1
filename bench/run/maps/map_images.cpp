// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/map_images.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "bench/report/drawing/canvas.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr int kMapMargin = 24;
constexpr double kMapWidth = 1100;

/// The bounding box of a grid's known cells: low (included) and high (excluded).
std::pair<Vector2i, Vector2i> known_part(const OccupancyGrid& grid) {
  constexpr int kFar = std::numeric_limits<int>::max();
  Vector2i low(kFar, kFar), high(0, 0);
  for (int y = 0; y < grid.cells.height(); ++y)
    for (int x = 0; x < grid.cells.width(); ++x)
      if (grid.cells(x, y) != kUnknownCell) {
        low = low.cwiseMin(Vector2i(x, y));
        high = high.cwiseMax(Vector2i(x + 1, y + 1));
      }
  if (low.x() == kFar) low.setZero();
  return {low, high};
}

/// A legend: a row of colored squares with words.
void draw_key(Canvas& canvas, double y, const std::vector<std::pair<std::string, Rgb8>>& entries) {
  double x = kMapMargin;
  for (const auto& [word, color] : entries) {
    const double width = 22 + Canvas::text_width(word, 10) + 16;
    if (x + width > canvas.width() - kMapMargin) {
      x = kMapMargin;
      y += 24;
    }
    canvas.fill(x, y - 11, 14, 14, color);
    canvas.text(word, {x + 20, y}, 10);
    x += width;
  }
}

Rgb8 color_of(ClassId label) {
  const ClassInfo& info = classes()[label];
  return {info.r, info.g, info.b};
}

}  // namespace

std::vector<MapPoint> points_of(const VoxelMap& map) {
  std::vector<MapPoint> points;
  map.for_each([&](const Voxel& voxel) {
    if (voxel.occupied && voxel.label != kVoid)
      points.push_back({voxel.center_m(map.resolution_m()), voxel.label});
  });
  return points;
}

cv::Mat draw_classes_over(const OccupancyGrid& grid, const std::vector<MapPoint>& points,
                          double ceiling_m) {
  constexpr Rgb8 kFloorTone{232, 234, 237}, kWallTone{90, 90, 90};
  constexpr double kSlant = 0.62,
                   kRise = 0.78;  // foreshortening along y and of heights
  const auto [low, high] = known_part(grid);
  const Vector2i size = high - low;
  const double px = (kMapWidth - 2 * kMapMargin) / std::max(1, size.x());  // per cell
  const double px_per_m = px / grid.resolution_m;
  const Vector2d corner = grid.origin_m + grid.resolution_m * low.cast<double>();
  std::vector<MapPoint> shown;
  std::map<ClassId, int> count;
  for (const MapPoint& p : points) {
    const Vector2d at = p.point_m.head<2>() - corner;
    if (p.label == kVoid || p.label == kBackground || p.point_m.z() > ceiling_m ||
        (at.array() < 0).any() || at.x() > size.x() * grid.resolution_m ||
        at.y() > size.y() * grid.resolution_m)
      continue;
    shown.push_back(p);
    ++count[p.label];
  }
  const auto rise_px = [&](const MapPoint& p) { return p.point_m.z() * px_per_m * kRise; };
  // Distance below the north edge of the grid, px.
  const auto down_px = [&](const MapPoint& p) {
    return (size.y() * grid.resolution_m - (p.point_m.y() - corner.y())) * px_per_m * kSlant;
  };
  double above_px = 0;
  for (const MapPoint& p : shown) above_px = std::max(above_px, rise_px(p) - down_px(p));
  const double top = kMapMargin + above_px;
  const int height = static_cast<int>(top + size.y() * px * kSlant + 134);
  Canvas canvas(static_cast<int>(kMapWidth), height);
  for (int y = high.y() - 1; y >= low.y(); --y)
    for (int x = low.x(); x < high.x(); ++x) {
      const std::int8_t cell = grid.cells(x, y);
      if (cell == kUnknownCell) continue;
      canvas.fill(kMapMargin + (x - low.x()) * px, top + (high.y() - 1 - y) * px * kSlant, px + 0.5,
                  px * kSlant + 0.5, cell == kOccupiedCell ? kWallTone : kFloorTone);
    }
  // Draws the farthest points first, so that nearer ones cover them, and equally far ones from the
  // lowest up.
  std::ranges::stable_sort(shown, [](const MapPoint& a, const MapPoint& b) {
    return std::make_pair(-a.point_m.y(), a.point_m.z()) <
           std::make_pair(-b.point_m.y(), b.point_m.z());
  });
  for (const MapPoint& p : shown) {
    canvas.disc(
        {kMapMargin + (p.point_m.x() - corner.x()) * px_per_m, top + down_px(p) - rise_px(p)}, 1.5,
        color_of(p.label));
  }
  canvas.text(
      "Seen from above and from the south: the grid on the floor, the points at their height; "
      "white: unknown.",
      {kMapMargin, height - 102.0}, 10);
  std::vector<std::pair<std::string, Rgb8>> entries{{"free", kFloorTone}, {"occupied", kWallTone}};
  for (const auto& [label, times] : count)
    if (times >= 20) entries.emplace_back(std::string(classes()[label].name), color_of(label));
  draw_key(canvas, height - 78, entries);
  return canvas.finish();
}

cv::Mat draw_against_truth(const OccupancyGrid& grid, const OccupancyGrid& plan) {
  constexpr Rgb8 kRightFree{238, 242, 238}, kRightObstacle{70, 70, 70},
      kMissedObstacle{222, 60, 50}, kInventedObstacle{240, 150, 40}, kNotSeen{170, 205, 240},
      kFreeElsewhere{150, 90, 200};
  const auto [low, high] = known_part(plan);
  const double px = (kMapWidth - 2 * kMapMargin) / std::max(1, high.x() - low.x());
  const int height = static_cast<int>(2 * kMapMargin + (high.y() - low.y()) * px + 60);
  Canvas canvas(static_cast<int>(kMapWidth), height);
  for (int y = low.y(); y < high.y(); ++y)
    for (int x = low.x(); x < high.x(); ++x) {
      const auto at = grid.cell_of(plan.center_m(x, y));
      const std::int8_t mapped = at ? grid.cells(at->x(), at->y()) : kUnknownCell;
      const std::int8_t is = plan.cells(x, y);
      Rgb8 color{255, 255, 255};
      if (is == kFreeCell)
        color = mapped == kFreeCell       ? kRightFree
                : mapped == kOccupiedCell ? kInventedObstacle
                                          : kNotSeen;
      else if (is == kOccupiedCell)
        color = mapped == kOccupiedCell ? kRightObstacle
                : mapped == kFreeCell   ? kMissedObstacle
                                        : Rgb8{200, 200, 200};
      else if (mapped == kFreeCell)
        color = kFreeElsewhere;
      else
        continue;
      canvas.fill(kMapMargin + (x - low.x()) * px, kMapMargin + (high.y() - 1 - y) * px, px + 0.3,
                  px + 0.3, color);
    }
  draw_key(canvas, height - 36,
           {{"free, right", kRightFree},
            {"obstacle, right", kRightObstacle},
            {"obstacle missed", kMissedObstacle},
            {"obstacle invented", kInventedObstacle},
            {"floor not seen", kNotSeen},
            {"obstacle not seen", Rgb8{200, 200, 200}},
            {"free but unreachable", kFreeElsewhere}});
  return canvas.finish();
}

}  // namespace mh
