// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/sensing.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "robots/model/odometry.hpp"
#include "slam/core/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kGravity_m_per_s2 = 9.81;
constexpr int kConeRings = 3;              // rays in a sonar's cone: 1 + 6 + 12 + 18
constexpr double kBumperReach_rad = 1.06;  // a bumper covers slightly more than 1/3 of the shell

std::vector<float> scan(const PlanarWorld& world, const LaserScanner& laser,
                        const SE3& world_from_base) {
  const SE3 world_from_laser = world_from_base * laser.base_from_laser;
  std::vector<float> ranges_m;
  for (int k = 0; k < laser.rays; ++k) {
    const double a = laser.field_of_view_rad * (static_cast<double>(k) / (laser.rays - 1) - 0.5);
    const Vector3d direction =
        world_from_laser.rotation() * Vector3d(std::cos(a), std::sin(a), 0.0);
    const auto hit = world.cast(world_from_laser.translation(), direction, laser.max_range_m);
    ranges_m.push_back(hit && *hit >= laser.min_range_m ? static_cast<float>(*hit) : 0.0F);
  }
  return ranges_m;
}

float ping(const PlanarWorld& world, const Sonar& sonar, const SE3& world_from_base) {
  const SE3 world_from_sonar = world_from_base * sonar.base_from_sonar;
  double nearest_m = sonar.max_range_m;
  bool found = false;
  for (int ring = 0; ring <= kConeRings; ++ring)
    for (int k = 0; k < std::max(1, 6 * ring); ++k) {
      const double off = 0.5 * sonar.field_of_view_rad * ring / kConeRings;
      const double around = 2 * M_PI * k / std::max(1, 6 * ring);
      const Vector3d direction =
          world_from_sonar.rotation() * Vector3d(std::cos(off), std::sin(off) * std::cos(around),
                                                 std::sin(off) * std::sin(around));
      const auto hit = world.cast(world_from_sonar.translation(), direction, nearest_m);
      if (!hit || *hit < sonar.min_range_m) continue;
      nearest_m = *hit;
      found = true;
    }
  if (!found) return 0.0F;
  if (sonar.resolution_m > 0)
    nearest_m = sonar.resolution_m * std::round(nearest_m / sonar.resolution_m);
  return static_cast<float>(nearest_m);
}

/// Fills in the IMU's readings, from the second difference of its position.
void feel(std::vector<RobotReading>& moments, const Trajectory& base, const SE3& base_from_imu) {
  const auto n = base.size();
  const auto world_from_imu = [&](std::size_t i) {
    return base[i].world_from_camera * base_from_imu;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1, c = std::min(i + 1, n - 1);
    const double before_s = 1e-9 * static_cast<double>(base[i].stamp_ns - base[a].stamp_ns);
    const double after_s = 1e-9 * static_cast<double>(base[c].stamp_ns - base[i].stamp_ns);
    const Vector3d here = world_from_imu(i).translation();
    Vector3d acceleration = Vector3d::Zero();
    if (before_s > 0 && after_s > 0)
      acceleration = ((world_from_imu(c).translation() - here) / after_s -
                      (here - world_from_imu(a).translation()) / before_s) /
                     (0.5 * (before_s + after_s));
    moments[i].specific_force_m_per_s2 = world_from_imu(i).rotation().transpose() *
                                         (acceleration + Vector3d(0, 0, kGravity_m_per_s2));
    if (before_s + after_s > 0)
      moments[i].turn_rad_per_s =
          so3_log((world_from_imu(a).inverse() * world_from_imu(c)).rotation()) /
          (before_s + after_s);
  }
}

}  // namespace

RobotReadings read_sensors(const Scene& scene, const Robot& robot, const Trajectory& base,
                           std::uint64_t seed, const std::vector<MovingObstacle>& others) {
  if (!robot.equipment)
    throw InputError(
        fmt::format("robot '{}' has no sensors: its file has no 'equipment'", robot.name));
  RobotReadings readings;
  if (base.empty()) return readings;
  const Equipment& equipment = *robot.equipment;
  readings.odometry = wheel_odometry(base, equipment.wheels, equipment.odometry, seed);
  const Vector2d start_m = base.front().world_from_camera.translation().head<2>();
  PlanarWorld world(scene, robot, start_m, 0.0);
  for (const MovingObstacle& other : others) world.add(other);
  for (const TimedPose& pose : base) {
    const SE3& world_from_base = pose.world_from_camera;
    const Vector2d place_m = world_from_base.translation().head<2>();
    const Vector3d ahead = world_from_base.rotation().col(0);
    world.place(place_m, std::atan2(ahead.y(), ahead.x()));
    world.show_at(1e-9 * static_cast<double>(pose.stamp_ns));
    RobotReading reading;
    reading.stamp_ns = pose.stamp_ns;
    for (const LaserScanner& laser : equipment.lasers)
      reading.lasers_m.push_back(scan(world, laser, world_from_base));
    for (const Sonar& sonar : equipment.sonars)
      reading.sonars_m.push_back(ping(world, sonar, world_from_base));
    const Contact contact = world.contact();
    for (const std::string& link : equipment.bumpers) {
      const Vector3d at = equipment.tree.root_from(link).translation();
      const Vector3d out = world_from_base.rotation() * Vector3d(at.x(), at.y(), 0.0).normalized();
      reading.bumpers.push_back(contact.touching && contact.direction.norm() > 0 &&
                                std::acos(std::clamp(contact.direction.dot(out.head<2>()), -1.0,
                                                     1.0)) < kBumperReach_rad);
    }
    readings.moments.push_back(std::move(reading));
  }
  feel(readings.moments, base, equipment.base_from_imu);
  return readings;
}

}  // namespace mh
