// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sim/motion/start.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

/// Number of ticks that a frame depends on: its motion, and what the exposure control saw before.
constexpr std::size_t kClip = 10;

Shutter::SceneAt moment_of_scene(const SimulatedScene& scene) {
  if (scene.pedestrian)
    return [walked = scene.pedestrian](Stamp stamp_ns) { return walked->at(stamp_ns); };
  return [renderer = scene.renderer](Stamp) { return renderer; };
}

const Robot& with_odometry(const Robot& robot) {
  if (robot.wheels() == nullptr)
    throw InputError(fmt::format(
        "robot '{}' has no wheels: it has no odometry (its file: equipment.wheels)", robot.name));
  return robot;
}

std::unique_ptr<CommandedBase> make_base(const SimulatedScene& scene, const Robot& robot,
                                         bool reflex, const Eigen::Vector2d& at_m,
                                         double heading_rad) {
  auto base = std::make_unique<CommandedBase>(*scene.scene, robot, at_m, heading_rad, reflex);
  if (scene.pedestrian) base->add(as_obstacle(*scene.scene, scene.pedestrian->pedestrian()));
  return base;
}

}  // namespace

Simulation::Simulation(SimulatedScene scene, const Robot& robot, const SensorConfig& level,
                       const SimulationConfig& config)
    : scene_(std::move(scene)),
      robot_(with_odometry(robot)),
      level_(level),
      config_(config),
      base_(make_base(scene_, robot, config.reflex, config.start_m, config.start_heading_rad)),
      odometer_(*robot.equipment->wheels, robot.equipment->odometry, config.seed) {
  robot_.camera = with_lens(robot_.camera, level_);
  check_start(base_->world(), *scene_.scene, config_.start_m, "start");
  odom_from_base_ = odometer_.drive_to(base_->world_from_base());
  recent_.push_back(pose_now());
}

TimedPose Simulation::pose_now() const {
  return {std::llround(static_cast<double>(ticks_) * 1e9 / robot_.camera.rate_hz),
          base_->world_from_base()};
}

void Simulation::tick() {
  ++ticks_;
  odom_before_ = odom_from_base_;
  odom_from_base_ = odometer_.drive_to(base_->world_from_base());
  recent_.push_back(pose_now());
  if (recent_.size() > kClip) recent_.erase(recent_.begin());
}

SensedMoment Simulation::frame() const {
  const std::size_t at = tick_before();
  const Stamp stamp_ns = recent_[at].stamp_ns;
  if (!light_)
    return {.frame = {.stamp_ns = stamp_ns,
                      .color = Grid2d<Rgb8>(robot_.camera.width_px, robot_.camera.height_px),
                      .depth_m = Grid2d<float>(robot_.camera.width_px, robot_.camera.height_px),
                      .semantics = {}},
            .exact = {}};
  Trajectory path;
  for (const TimedPose& pose : recent_)
    path.push_back({pose.stamp_ns, pose.world_from_camera * robot_.base_from_camera});
  const Shutter shutter(moment_of_scene(scene_), robot_.camera, std::move(path), level_);
  const RandomStream noise = RandomStream(config_.seed).fork(static_cast<std::uint64_t>(ticks_));
  return sense_moment(shutter, level_, config_.labels, at, noise);
}

RobotObservation Simulation::step(const Twist2d& command, double dt_s) {
  const long ticks = std::max(1L, std::lround(dt_s * robot_.camera.rate_hz));
  RobotObservation seen;
  bool due = false;
  std::vector<bool> pressed(robot_.equipment->bumpers.size(), false);
  for (long t = 0; t < ticks; ++t) {
    for (int s = 0; s < base_->steps_per_frame(); ++s) {
      base_->step(command);
      const std::vector<bool> now =
          base_->contact().touching
              ? pressed_bumpers(base_->contact(), *robot_.equipment, base_->world_from_base())
              : std::vector<bool>(pressed.size(), false);
      for (std::size_t b = 0; b < pressed.size(); ++b) pressed[b] = pressed[b] || now[b];
    }
    tick();
    due = due || ticks_ % config_.ticks_per_frame == 0;
  }
  if (due) {
    SensedMoment moment = frame();
    const TimedPose& then = recent_[tick_before()];
    frame_pose_ = {then.stamp_ns, then.world_from_camera * robot_.base_from_camera};
    seen.frame = std::move(moment.frame);
    seen.instances = std::move(moment.exact.instances);
  }
  seen.reading = read_ranges(base_->world(), *robot_.equipment, base_->world_from_base(),
                             laser_noise(config_.seed, static_cast<std::size_t>(ticks_)));
  seen.stamp_ns = seen.reading.stamp_ns = recent_.back().stamp_ns;
  seen.reading.bumpers = std::move(pressed);
  const std::size_t n = recent_.size(), here = tick_before();
  if (robot_.equipment->base_from_imu)
    feel(seen.reading, recent_[here == 0 ? 0 : here - 1], recent_[here], recent_[n - 1],
         *robot_.equipment->base_from_imu);
  seen.odom_from_base = odom_from_base_;
  seen.odom_from_camera = odom_before_ * robot_.base_from_camera;
  return seen;
}

void Simulation::carry_to(const Eigen::Vector2d& place_m, double heading_rad) {
  const BaseState before = base_->state();
  base_->carry_to(place_m, heading_rad);
  try {
    check_start(base_->world(), *scene_.scene, place_m, "carried");
  } catch (...) {
    base_->carry_to(before.position_m, before.heading_rad);
    throw;
  }
  odometer_.lift_to(base_->world_from_base());
  recent_.clear();
  recent_.push_back(pose_now());
}

void Simulation::change_scene(SimulatedScene scene) {
  const BaseState now = base_->state();
  auto base = make_base(scene, robot_, config_.reflex, now.position_m, now.heading_rad);
  check_start(base->world(), *scene.scene, now.position_m, "robot");
  base->set_time(time_s());
  base_ = std::move(base);
  scene_ = std::move(scene);
}

}  // namespace mh
