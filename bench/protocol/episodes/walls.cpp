// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/episodes/walls.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "scenes/band.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr double kBeforeThing_m = 0.02;

/// Whether, along an axis, all corners are on one side of the interval between a and b.
bool beside(std::span<const Vector2d> corners_m, const Vector2d& axis, double a, double b) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector2d& corner : corners_m) {
    low = std::min(low, axis.dot(corner));
    high = std::max(high, axis.dot(corner));
  }
  return low > std::max(a, b) || high < std::min(a, b);
}

Vector2d normal_to(const Vector2d& side) {
  return {-side.y(), side.x()};
}

/// A separating-axis test (Gottschalk, Lin and Manocha, "OBBTree", 1996), in the plane.
bool crosses(std::span<const Vector2d> corners_m, const Vector2d& from_m, const Vector2d& to_m) {
  const auto apart_along = [&](const Vector2d& axis) {
    return beside(corners_m, axis, axis.dot(from_m), axis.dot(to_m));
  };
  const Vector2d line = to_m - from_m;
  if (apart_along(line) || apart_along(normal_to(line))) return false;
  for (std::size_t i = 0; i < corners_m.size(); ++i) {
    const Vector2d side = corners_m[(i + 1) % corners_m.size()] - corners_m[i];
    if (!side.isZero() && apart_along(normal_to(side))) return false;
  }
  return true;
}

}  // namespace

TrueWalls::TrueWalls(const Scene& scene, double robot_height_m) {
  const auto wall = class_by_name("wall");
  for_each_face_in_band(scene, static_cast<float>(scene.floor.rough_m),
                        static_cast<float>(robot_height_m),
                        [&](std::size_t face, std::span<const Eigen::Vector3f> polygon) {
                          if (scene.class_of[face] != wall) return;
                          Outline outline;
                          for (const Eigen::Vector3f& corner : polygon) {
                            outline.corners_m.emplace_back(corner.head<2>().cast<double>());
                            outline.bounds_m.extend(outline.corners_m.back());
                          }
                          outlines_.push_back(std::move(outline));
                        });
}

bool TrueWalls::between(const Vector2d& from_m, const Vector2d& to_m) const {
  const double length_m = (to_m - from_m).norm();
  if (length_m <= kBeforeThing_m) return false;
  const Vector2d end_m = from_m + (1 - kBeforeThing_m / length_m) * (to_m - from_m);
  const Eigen::AlignedBox2d around = Eigen::AlignedBox2d(from_m).extend(end_m);
  return std::ranges::any_of(outlines_, [&](const Outline& outline) {
    return around.intersects(outline.bounds_m) && crosses(outline.corners_m, from_m, end_m);
  });
}

}  // namespace mh
