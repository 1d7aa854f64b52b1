// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/sensing.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "robots/model/odometry.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kGravity_m_per_s2 = 9.81;
constexpr int kConeRings = 3;              // rays in a sonar's cone: 1 + 6 + 12 + 18
constexpr double kBumperReach_rad = 1.06;  // a bumper covers slightly more than 1/3 of the shell

std::vector<float> scan(const PlanarWorld& world, const LaserScanner& laser,
                        const SE3& world_from_base, RandomStream noise) {
  const SE3 world_from_laser = world_from_base * laser.base_from_laser;
  std::vector<float> ranges_m;
  for (int k = 0; k < laser.rays; ++k) {
    const double a = laser.angle_rad(static_cast<std::size_t>(k));
    const Vector3d direction =
        world_from_laser.rotation() * Vector3d(std::cos(a), std::sin(a), 0.0);
    const auto hit = world.cast(world_from_laser.translation(), direction, laser.max_range_m);
    double range_m = hit.value_or(0.0);
    if (const double sigma_m = std::max(laser.sigma_m, laser.sigma_share * range_m);
        hit && sigma_m > 0)
      range_m += sigma_m * noise.normal(static_cast<std::uint64_t>(k));
    const bool is_measured = hit && range_m >= laser.min_range_m && range_m <= laser.max_range_m;
    ranges_m.push_back(is_measured ? static_cast<float>(range_m) : 0.0F);
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

}  // namespace

const Equipment& equipment_with_lasers(const Robot& robot) {
  if (!robot.equipment || robot.equipment->lasers.empty())
    throw InputError(
        fmt::format("robot '{}' has no lasers (its file: equipment.lasers)", robot.name));
  return *robot.equipment;
}

RandomStream laser_noise(std::uint64_t seed, std::size_t tick) {
  constexpr std::uint64_t kLasers = ~0ULL;  // the streams of frames use the number of their tick
  return RandomStream(seed).fork(kLasers).fork(tick);
}

std::vector<std::vector<float>> read_lasers(const PlanarWorld& world, const Equipment& equipment,
                                            const SE3& world_from_base, RandomStream noise) {
  std::vector<std::vector<float>> lasers_m;
  for (const LaserScanner& laser : equipment.lasers)
    lasers_m.push_back(scan(world, laser, world_from_base, noise.fork(lasers_m.size())));
  return lasers_m;
}

RobotReading read_ranges(const PlanarWorld& world, const Equipment& equipment,
                         const SE3& world_from_base, RandomStream noise) {
  RobotReading reading;
  reading.lasers_m = read_lasers(world, equipment, world_from_base, noise);
  for (const Sonar& sonar : equipment.sonars)
    reading.sonars_m.push_back(ping(world, sonar, world_from_base));
  return reading;
}

std::vector<bool> pressed_bumpers(const Contact& contact, const Equipment& equipment,
                                  const SE3& world_from_base) {
  std::vector<bool> pressed;
  for (const std::string& link : equipment.bumpers) {
    const Vector3d at = equipment.base_from(link).translation();
    const Vector3d out = world_from_base.rotation() * Vector3d(at.x(), at.y(), 0.0).normalized();
    pressed.push_back(contact.touching && contact.direction.norm() > 0 &&
                      std::acos(std::clamp(contact.direction.dot(out.head<2>()), -1.0, 1.0)) <
                          kBumperReach_rad);
  }
  return pressed;
}

void feel(RobotReading& reading, const TimedPose& before, const TimedPose& here,
          const TimedPose& after, const SE3& base_from_imu) {
  const auto world_from_imu = [&](const TimedPose& pose) {
    return pose.world_from_camera * base_from_imu;
  };
  const double before_s = 1e-9 * static_cast<double>(here.stamp_ns - before.stamp_ns);
  const double after_s = 1e-9 * static_cast<double>(after.stamp_ns - here.stamp_ns);
  const Vector3d place_m = world_from_imu(here).translation();
  Vector3d acceleration = Vector3d::Zero();
  if (before_s > 0 && after_s > 0)
    acceleration = ((world_from_imu(after).translation() - place_m) / after_s -
                    (place_m - world_from_imu(before).translation()) / before_s) /
                   (0.5 * (before_s + after_s));
  reading.specific_force_m_per_s2 = world_from_imu(here).rotation().transpose() *
                                    (acceleration + Vector3d(0, 0, kGravity_m_per_s2));
  if (before_s + after_s > 0)
    reading.turn_rad_per_s =
        so3_log((world_from_imu(before).inverse() * world_from_imu(after)).rotation()) /
        (before_s + after_s);
}

RobotReadings read_sensors(const Scene& scene, const Robot& robot, const Trajectory& base,
                           std::uint64_t seed, const std::vector<MovingObstacle>& others) {
  if (!robot.equipment)
    throw InputError(
        fmt::format("robot '{}' has no sensors: its file has no 'equipment'", robot.name));
  RobotReadings readings;
  if (base.empty()) return readings;
  const Equipment& equipment = *robot.equipment;
  if (equipment.wheels)
    readings.odometry = wheel_odometry(base, *equipment.wheels, equipment.odometry, seed);
  const Vector2d start_m = base.front().world_from_camera.translation().head<2>();
  PlanarWorld world(scene, robot, start_m, 0.0);
  for (const MovingObstacle& other : others) world.add(other);
  for (std::size_t i = 0; i < base.size(); ++i) {
    const SE3& world_from_base = base[i].world_from_camera;
    const Vector2d place_m = world_from_base.translation().head<2>();
    const Vector3d ahead = world_from_base.rotation().col(0);
    world.place(place_m, std::atan2(ahead.y(), ahead.x()));
    world.show_at(1e-9 * static_cast<double>(base[i].stamp_ns));
    RobotReading reading = read_ranges(world, equipment, world_from_base, laser_noise(seed, i));
    reading.stamp_ns = base[i].stamp_ns;
    reading.bumpers = pressed_bumpers(world.contact(), equipment, world_from_base);
    if (equipment.base_from_imu)
      feel(reading, base[i == 0 ? 0 : i - 1], base[i], base[std::min(i + 1, base.size() - 1)],
           *equipment.base_from_imu);
    readings.moments.push_back(std::move(reading));
  }
  return readings;
}

}  // namespace mh
