// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/laser_scans.hpp"

#include <utility>

#include "bench/protocol/episodes/robot_map.hpp"
#include "bench/run/maps/map_study.hpp"
#include "scenes/floor.hpp"
#include "sim/motion/sensing.hpp"
#include "sim/physics/planar_world.hpp"

namespace mh {

struct SceneLasers::Impl {
  Impl(const Scene& scene, Robot r)
      : level(scene), robot(std::move(r)), world(*level, robot, Eigen::Vector2d::Zero(), 0) {}
  LevelScene level;
  Robot robot;
  PlanarWorld world;
};

SceneLasers::SceneLasers(const Scene& scene, Robot robot) {
  equipment_with_lasers(robot);
  impl_ = std::make_unique<Impl>(scene, std::move(robot));
}
SceneLasers::~SceneLasers() = default;
SceneLasers::SceneLasers(SceneLasers&&) noexcept = default;

ScanGrid SceneLasers::scans(const Trajectory& map_from_camera, const Trajectory& world_from_camera,
                            double resolution_m) const {
  const Robot& robot = impl_->robot;
  const SE3 camera_from_base = robot.base_from_camera.inverse(),
            level_from_world = impl_->level.world_from_level().inverse();
  ScanGrid scans(resolution_m);
  for (const TimedPose& pose : map_from_camera) {
    const TimedPose* is_at = pose_at(world_from_camera, pose.stamp_ns);
    if (is_at == nullptr) continue;
    const SE3 level_from_base = level_from_world * is_at->world_from_camera * camera_from_base;
    const auto lasers_m =
        read_lasers(impl_->world, *robot.equipment, level_from_base,
                    RandomStream(0).fork(static_cast<std::uint64_t>(pose.stamp_ns)));
    add_scans(scans, *robot.equipment, pose.world_from_camera * camera_from_base, lasers_m);
  }
  return scans;
}

}  // namespace mh
