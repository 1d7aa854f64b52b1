// SPDX-License-Identifier: Apache-2.0
#include "bench/live/errand.hpp"

#include <utility>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr std::size_t kMostViews = 200;

}  // namespace

void KeptViews::see(const RobotObservation& seen, const SE3& world_from_camera) {
  if (!views_.empty()) {
    const SE3& last = views_.back().world_from_camera;
    if ((world_from_camera.translation() - last.translation()).norm() < apart_m_ &&
        angle_between_rad(world_from_camera, last) < apart_rad_)
      return;
  }
  views_.push_back({*seen.frame, seen.reading.lasers_m, world_from_camera});
  views_.back().frame.color = {};  // the map needs none
  if (views_.size() <= kMostViews) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < views_.size(); i += 2) std::swap(views_[kept++], views_[i]);
  views_.resize(kept);
  apart_m_ *= 2;
  apart_rad_ *= 1.5;
}

Errand::Errand(const KeptViews& views, const Trajectory& estimate, const Robot& robot,
               const std::string& goal)
    : robot_(robot), goal_(goal) {
  if (const char* lacking = lacking_to_drive(robot); lacking != nullptr)
    throw InputError(fmt::format("robot '{}' has no {} to drive by", robot.name, lacking));
  map_ = std::make_unique<const RobotMap>(
      build_robot_map({.frames = views,
                       .estimate = estimate,
                       .robot = robot,
                       .noise = RandomStream(0),
                       .lasers = [&](std::size_t i) { return views.lasers_m(i); }}));
  if (map_->empty()) throw InputError("there is no map yet: drive around first");
  navigator_ = std::make_unique<Navigator>(map_->known, robot_, goals_named(*map_, goal));
}

Twist2d Errand::step(double time_s, const RobotObservation& seen,
                     const std::optional<SE3>& world_from_camera) {
  const SE3 camera_from_base = robot_.base_from_camera.inverse();
  Perception now{.time_s = time_s,
                 .odom_from_base = from_above(seen.odom_from_base),
                 .lasers_m = seen.reading.lasers_m,
                 .bumpers = seen.reading.bumpers,
                 .seen = {}};
  if (seen.frame) {
    now.seen =
        Perception::Seen{.depth_m = &seen.frame->depth_m,
                         .odom_from_base = from_above(seen.odom_from_camera * camera_from_base),
                         .map_from_base = {}};
    if (world_from_camera)
      now.seen->map_from_base =
          from_above(map_->map_from_estimate * *world_from_camera * camera_from_base);
  }
  return navigator_->step(now);
}

std::vector<Eigen::Vector3d> Errand::path() const {
  std::vector<Eigen::Vector3d> path;
  if (!navigator_->knows_its_place()) return path;
  const SE3 estimate_from_map = map_->map_from_estimate.inverse();
  for (const Eigen::Vector2d& p : navigator_->path())
    path.push_back(estimate_from_map * Eigen::Vector3d(p.x(), p.y(), 0));
  return path;
}

}  // namespace mh
