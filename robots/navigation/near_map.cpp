// SPDX-License-Identifier: Apache-2.0
#include "robots/navigation/near_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kColumnStep_px = 8, kRowStep_px = 6;  // 5 cm by 4 cm at 3.5 m in 640 x 480
constexpr double kShort_m = 0.15;  // a ray stops clearing this far before an obstacle
constexpr double kMove_m = 1.0;    // the window moves in steps of this size

Vector2d ahead_of(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

}  // namespace

NearMap::NearMap(const NearMapConfig& config)
    : config_(config),
      cells_(2 * static_cast<int>(std::ceil(config.half_size_m / config.resolution_m))),
      corner_(-cells_ / 2, -cells_ / 2),
      layers_(cells_, cells_) {}

void NearMap::clear() {
  std::fill(layers_.begin(), layers_.end(), std::uint8_t{0});
}

Vector2d NearMap::center_of(int x, int y) const {
  return config_.resolution_m * (corner_ + Eigen::Vector2i(x, y)).cast<double>();
}

std::uint8_t* NearMap::cell(const Vector2d& place_m) {
  const int x = static_cast<int>(std::lround(place_m.x() / config_.resolution_m)) - corner_.x();
  const int y = static_cast<int>(std::lround(place_m.y() / config_.resolution_m)) - corner_.y();
  return layers_.contains(x, y) ? &layers_(x, y) : nullptr;
}

void NearMap::move_to(const Vector2d& place_m) {
  const Vector2d middle = center_of(cells_ / 2, cells_ / 2);
  if ((place_m - middle).cwiseAbs().maxCoeff() < kMove_m) return;
  const Eigen::Vector2i corner(
      static_cast<int>(std::lround(place_m.x() / config_.resolution_m)) - cells_ / 2,
      static_cast<int>(std::lround(place_m.y() / config_.resolution_m)) - cells_ / 2);
  const Eigen::Vector2i shift = corner - corner_;
  Grid2d<std::uint8_t> moved(cells_, cells_);
  for (int y = 0; y < cells_; ++y)
    for (int x = 0; x < cells_; ++x)
      if (layers_.contains(x + shift.x(), y + shift.y()))
        moved(x, y) = layers_(x + shift.x(), y + shift.y());
  layers_ = std::move(moved);
  corner_ = corner;
}

void NearMap::see_through(const Vector2d& start_m, const Vector2d& direction, double from_m,
                          double to_m, Layer layer) {
  for (double at_m = from_m; at_m <= to_m; at_m += 0.5 * config_.resolution_m)
    if (std::uint8_t* c = cell(start_m + at_m * direction))
      *c = static_cast<std::uint8_t>((*c & ~layer) | kSeen);
}

void NearMap::add_lasers(const Equipment& equipment, std::span<const std::vector<float>> lasers_m,
                         const Pose2& odom_from_base) {
  move_to(odom_from_base.place_m);
  if (std::uint8_t* c = cell(odom_from_base.place_m)) *c |= kSeen;  // the robot is there
  for (std::size_t l = 0; l < std::min(lasers_m.size(), equipment.lasers.size()); ++l) {
    const LaserScanner& laser = equipment.lasers[l];
    const Pose2 odom_from_laser = odom_from_base * from_above(laser.base_from_laser);
    for (std::size_t k = 0; k < lasers_m[l].size(); ++k) {
      const Vector2d direction = ahead_of(odom_from_laser.heading_rad + laser.angle_rad(k));
      const double range_m = static_cast<double>(lasers_m[l][k]);
      const double free_m = range_m > 0 ? range_m - config_.resolution_m : laser.max_range_m;
      see_through(odom_from_laser.place_m, direction, 0, free_m, kLaser);
      if (range_m <= 0) continue;
      if (std::uint8_t* c = cell(odom_from_laser.place_m + range_m * direction))
        *c |= kLaser | kSeen;
    }
  }
}

void NearMap::add_depth(const Grid2d<float>& depth_m, const Camera& camera,
                        const SE3& base_from_camera, const Pose2& odom_from_base) {
  move_to(odom_from_base.place_m);
  const Vector2d eye_m = odom_from_base * Vector2d(base_from_camera.translation().head<2>());
  struct Mark {
    Vector2d place_m;
  };
  std::vector<Mark> marks;
  for (int u = kColumnStep_px / 2; u < depth_m.width(); u += kColumnStep_px) {
    double nearest_m = config_.max_depth_m;
    int returns = 0;
    Vector2d direction = Vector2d::Zero();
    for (int v = kRowStep_px / 2; v < depth_m.height(); v += kRowStep_px) {
      const double z = static_cast<double>(depth_m(u, v));
      if (z <= 0) continue;
      ++returns;
      const Vector3d in_base = base_from_camera * camera.unproject(u, v, z);
      const Vector2d place_m = odom_from_base * Vector2d(in_base.head<2>());
      const double away_m = (place_m - eye_m).norm();
      if (direction.isZero(0) && away_m > 0) direction = (place_m - eye_m) / away_m;
      if (in_base.z() < config_.bottom_m || in_base.z() > config_.top_m ||
          away_m > config_.max_depth_m)
        continue;
      nearest_m = std::min(nearest_m, away_m);
      marks.push_back({place_m});
    }
    // A column with few returns shows too little to call anything free.
    if (4 * returns * kRowStep_px < depth_m.height()) continue;
    see_through(eye_m, direction, config_.blind_m, nearest_m - kShort_m, kDepth);
  }
  for (const Mark& mark : marks)
    if (std::uint8_t* c = cell(mark.place_m)) *c |= kDepth | kSeen;
}

void NearMap::add_contact(const Vector2d& place_in_odom_m) {
  if (std::uint8_t* c = cell(place_in_odom_m)) *c |= kTouched | kSeen;
}

std::vector<Vector2d> NearMap::obstacles_near(const Vector2d& place_m, double radius_m) const {
  std::vector<Vector2d> near;
  const int reach = static_cast<int>(std::ceil(radius_m / config_.resolution_m)) + 1;
  const int cx = static_cast<int>(std::lround(place_m.x() / config_.resolution_m)) - corner_.x();
  const int cy = static_cast<int>(std::lround(place_m.y() / config_.resolution_m)) - corner_.y();
  for (int y = cy - reach; y <= cy + reach; ++y)
    for (int x = cx - reach; x <= cx + reach; ++x)
      if (layers_.contains(x, y) && (layers_(x, y) & (kLaser | kDepth | kTouched)) != 0 &&
          (center_of(x, y) - place_m).norm() <= radius_m)
        near.push_back(center_of(x, y));
  return near;
}

FloorGrid NearMap::grid() const {
  Grid2d<std::uint8_t> blocked(cells_, cells_);
  for (int y = 0; y < cells_; ++y)
    for (int x = 0; x < cells_; ++x)
      blocked(x, y) =
          (layers_(x, y) & kSeen) == 0 || (layers_(x, y) & (kLaser | kDepth | kTouched)) != 0;
  return floor_grid_of(blocked, config_.resolution_m, center_of(0, 0));
}

}  // namespace mh
