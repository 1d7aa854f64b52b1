// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/lasers_along.hpp"

#include <algorithm>
#include <utility>

#include "sim/motion/sensing.hpp"

namespace mh {

LasersAlong::LasersAlong(std::shared_ptr<const Scene> scene, const Robot& robot,
                         const DrivenPath& path, std::uint64_t seed,
                         const std::vector<MovingObstacle>& others)
    : scene_(std::move(scene)),
      level_(*scene_),
      equipment_(equipment_with_lasers(robot)),
      base_(path.base),
      camera_(path.camera),
      seed_(seed),
      world_(*level_, robot, Eigen::Vector2d::Zero(), 0) {
  for (const MovingObstacle& other : others) world_.add(other);
}

std::vector<LaserScan> LasersAlong::at(std::size_t i) const {
  const SE3& world_from_base = base_[i].world_from_camera;
  const SE3 camera_from_base = camera_[i].world_from_camera.inverse() * world_from_base;
  std::vector<std::vector<float>> lasers_m;
  {
    const std::lock_guard lock(one_at_a_time_);
    world_.show_at(1e-9 * static_cast<double>(base_[i].stamp_ns));
    lasers_m =
        read_lasers(world_, equipment_, level_.world_from_level().inverse() * world_from_base,
                    laser_noise(seed_, i));
  }
  std::vector<LaserScan> scans;
  for (std::size_t k = 0; k < lasers_m.size(); ++k) {
    const LaserScanner& laser = equipment_.lasers[k];
    scans.push_back({.name = laser.name,
                     .camera_from_laser = camera_from_base * laser.base_from_laser,
                     .first_rad = -0.5 * laser.field_of_view_rad,
                     .step_rad = laser.field_of_view_rad / std::max(1, laser.rays - 1),
                     .min_range_m = laser.min_range_m,
                     .max_range_m = laser.max_range_m,
                     .ranges_m = std::move(lasers_m[k])});
  }
  return scans;
}

}  // namespace mh
