// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/floor_frame.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "slam/core/random.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;

constexpr double kOnPlane_m =
    0.04;  // points on a plane are at most this far from it: the depth noise at 4 m
constexpr double kSteepest = 0.7;  // least cosine between a floor's normal and the cameras' mean up
                                   // axis; below 1, since handheld cameras look down
constexpr double kLeastHeight_m = 0.15;  // least height of a camera above the floor
constexpr double kMostBelow = 0.05;  // largest share of all points that may be well below the floor
constexpr double kBelow_m = 0.15;    // what "well below" means
constexpr std::size_t kLeastPoints = 20;  // needed for a floor
// At least this share of the points within twice kOnPlane_m of a floor must be within kOnPlane_m.
// Where a plane only cuts through walls, the share is about one half.
constexpr double kLeastFlat = 0.65;
constexpr ClassId kFloorClass = 2, kMatClass = 20;

struct Plane {
  Vector3d up = Vector3d::UnitZ();
  double offset_m = 0;  ///< up . p for its points p
  double height(const Vector3d& point) const { return up.dot(point) - offset_m; }
};

/// What a plane is checked against, in addition to the points that it is fitted to: the whole map
/// and the cameras.
struct Surroundings {
  std::span<const LabeledPoint> all;
  std::span<const SE3> cameras;
  Vector3d up;  ///< of the cameras, on average
};

std::size_t count_on(const Plane& plane, const std::vector<Vector3d>& points,
                     double within_m = kOnPlane_m) {
  return static_cast<std::size_t>(std::ranges::count_if(
      points, [&](const Vector3d& p) { return std::abs(plane.height(p)) < within_m; }));
}

/// Whether the points on a plane form a surface, rather than being cut out of walls.
bool is_surface(const Plane& plane, std::size_t on, const std::vector<Vector3d>& points) {
  return static_cast<double>(on) >=
         kLeastFlat * static_cast<double>(count_on(plane, points, 2 * kOnPlane_m));
}

/// Whether all cameras are above a plane and almost no points are below it.
bool can_be_floor(const Plane& plane, const Surroundings& around) {
  if (plane.up.dot(around.up) < kSteepest) return false;
  for (const SE3& camera : around.cameras)
    if (plane.height(camera.translation()) < kLeastHeight_m) return false;
  std::size_t below = 0;
  for (const LabeledPoint& p : around.all)
    if (plane.height(p.point_in_world) < -kBelow_m) ++below;
  return static_cast<double>(below) <= kMostBelow * static_cast<double>(around.all.size());
}

/// Refits a plane by least squares to the points on it.
Plane refined(const Plane& plane, const std::vector<Vector3d>& points) {
  Vector3d mean = Vector3d::Zero();
  double count = 0;
  for (const Vector3d& p : points)
    if (std::abs(plane.height(p)) < kOnPlane_m) mean += p, ++count;
  if (count < 3) return plane;
  mean /= count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points)
    if (std::abs(plane.height(p)) < kOnPlane_m) spread += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  Plane better;
  better.up = solver.eigenvectors().col(0);
  if (better.up.dot(plane.up) < 0) better.up = -better.up;
  better.offset_m = better.up.dot(mean);
  return better;
}

/// The plane with the most points among those planes that can be a floor; RANSAC with its own
/// random draws.
std::optional<Plane> best_plane(const std::vector<Vector3d>& points, const Surroundings& around) {
  if (points.size() < kLeastPoints) return std::nullopt;
  constexpr std::uint64_t kDraws =
      500;  // finds a plane that holds a fifth of the points with probability 0.98
  const RandomStream draws(0x666c6f6f72);
  std::optional<Plane> best;
  std::size_t most = kLeastPoints - 1;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const Vector3d& a = points[draws.below(3 * i, points.size())];
    const Vector3d& b = points[draws.below(3 * i + 1, points.size())];
    const Vector3d& c = points[draws.below(3 * i + 2, points.size())];
    const Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() < 1e-3) continue;  // the points are nearly on a line
    Plane plane{.up = normal.normalized(), .offset_m = 0};
    if (plane.up.dot(around.up) < 0) plane.up = -plane.up;
    if (plane.up.dot(around.up) < kSteepest) continue;
    plane.offset_m = plane.up.dot(a);
    const std::size_t on = count_on(plane, points);
    if (on <= most || !is_surface(plane, on, points) || !can_be_floor(plane, around)) continue;
    best = plane;
    most = on;
  }
  if (!best) return best;
  const Plane fitted = refined(refined(*best, points), points);
  return can_be_floor(fitted, around) ? fitted : *best;
}

/// floor_from_world of a plane: x is the viewing direction of the first camera, which is above the
/// origin.
SE3 frame_of(const Plane& plane, const SE3& first) {
  Vector3d x = first.rotation().col(2);
  x -= plane.up.dot(x) * plane.up;
  if (x.norm() <
      0.1) {  // the camera looks straight down: ahead is where the image's upper edge points
    x = -first.rotation().col(1);
    x -= plane.up.dot(x) * plane.up;
  }
  x.normalize();
  Eigen::Matrix3d rows;
  rows.row(0) = x.transpose();
  rows.row(1) = plane.up.cross(x).transpose();
  rows.row(2) = plane.up.transpose();
  const Vector3d foot = first.translation() - plane.height(first.translation()) * plane.up;
  return {rows, -(rows * foot)};
}

double median_distance(const Plane& plane, const std::vector<Vector3d>& points) {
  std::vector<double> away;
  for (const Vector3d& p : points)
    if (std::abs(plane.height(p)) < kOnPlane_m) away.push_back(std::abs(plane.height(p)));
  if (away.empty()) return 0;
  const auto middle = away.begin() + static_cast<std::ptrdiff_t>(away.size() / 2);
  std::nth_element(away.begin(), middle, away.end());
  return *middle;
}

}  // namespace

std::optional<FloorFrame> find_floor_frame(std::span<const LabeledPoint> points,
                                           std::span<const SE3> world_from_cameras) {
  if (world_from_cameras.empty()) return std::nullopt;
  Surroundings around{.all = points, .cameras = world_from_cameras, .up = Vector3d::Zero()};
  for (const SE3& camera : world_from_cameras) around.up -= camera.rotation().col(1);
  if (around.up.norm() < 1e-6) return std::nullopt;
  around.up.normalize();

  std::vector<Vector3d> labeled, all;
  for (const LabeledPoint& p : points) {
    all.push_back(p.point_in_world);
    if (p.label == kFloorClass || p.label == kMatClass) labeled.push_back(p.point_in_world);
  }
  std::optional<Plane> plane = best_plane(labeled, around);
  const bool by_labels = plane.has_value();
  if (!plane) plane = best_plane(all, around);
  if (!plane) return std::nullopt;
  return FloorFrame{.floor_from_world = frame_of(*plane, world_from_cameras.front()),
                    .spread_m = median_distance(*plane, by_labels ? labeled : all),
                    .points = count_on(*plane, by_labels ? labeled : all),
                    .by_labels = by_labels};
}

}  // namespace mh
