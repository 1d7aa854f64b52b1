// SPDX-License-Identifier: Apache-2.0
#include "robots/model/wheel_base.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "robots/model/odometry.hpp"
#include "slam/core/random.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

const Robot& pepper() {
  static const Robot robot = load_robot(MH_SOURCE_DIR "/robots/pepper/pepper.yaml");
  return robot;
}
const OmniWheels& wheels() {
  return pepper().equipment->wheels;
}

TEST(OmniWheels, AheadTheFrontWheelsDriveAndTheRearOneRolls) {
  const Eigen::Vector3d rims = rim_speeds_m_per_s(wheels(), {1, 0, 0});
  EXPECT_NEAR(rims[0], -std::sin(1.07517), 1e-9);  // front left
  EXPECT_NEAR(rims[1], std::sin(1.07517), 1e-9);   // front right
  EXPECT_NEAR(rims[2], 0.0, 1e-9);                 // rear
  // Turning about the middle: each rim goes as fast as its wheel's place moves along its drive.
  const Eigen::Vector3d turning = rim_speeds_m_per_s(wheels(), {0, 0, 1});
  EXPECT_NEAR(turning[2], 0.170, 1e-9);
  EXPECT_NEAR(turning[0], 0.1792, 3e-4);  // its axle misses the middle by 1.7 deg
  const Twist2d twist(0.2, -0.1, 0.4);
  EXPECT_TRUE(twist_of_rims(wheels(), rim_speeds_m_per_s(wheels(), twist)).isApprox(twist, 1e-12));
}

/// A velocity in any direction, up to the given speed.
JerkLimiter::Velocity any_velocity(const RandomStream& draw, std::uint64_t i, double most_m_per_s) {
  const double angle = draw.uniform(4 * i + 1, -M_PI, M_PI);
  return {.m_per_s = draw.uniform(4 * i + 2, 0, most_m_per_s) *
                     Eigen::Vector2d(std::cos(angle), std::sin(angle)),
          .turn_rad_per_s = draw.uniform(4 * i + 3, -2, 2)};
}

TEST(JerkLimiter, NoRimGoesFasterThanItCan) {
  constexpr double h = 1.0 / 240;
  JerkLimiter limiter(pepper().limits, h, &wheels());
  const RandomStream draw(9);
  double heading = 0, top = 0;
  JerkLimiter::Velocity command;
  for (std::uint64_t i = 0; i < 200000; ++i) {
    if (i % 120 == 0 && draw.uniform(4 * i) < 0.5) command = any_velocity(draw, i, 0.7);
    const JerkLimiter::Velocity v = limiter.step(command);
    const Eigen::Vector2d in_base = Eigen::Rotation2Dd(-heading) * v.m_per_s;
    const double rim = rim_speeds_m_per_s(wheels(), {in_base.x(), in_base.y(), v.turn_rad_per_s})
                           .cwiseAbs()
                           .maxCoeff();
    ASSERT_LE(rim, wheels().max_rim_m_per_s) << i;
    top = std::max(top, rim);
    heading += v.turn_rad_per_s * h;
  }
  EXPECT_GT(top, 0.9 * wheels().max_rim_m_per_s);
  for (int i = 0; i < 2400; ++i) limiter.step({.m_per_s = {0.42, 0}});
  EXPECT_NEAR(limiter.step({.m_per_s = {0.42, 0}}).m_per_s.x(), 0.42, 1e-3);  // it is reached
  for (int i = 0; i < 2400; ++i) limiter.step({.turn_rad_per_s = 1.0});
  EXPECT_NEAR(limiter.step({.turn_rad_per_s = 1.0}).turn_rad_per_s, 1.0, 1e-3);
}

TEST(JerkLimiter, NeverExceedsALimitUnderCommandsThatJump) {
  const BaseLimits& limits = pepper().limits;
  constexpr double h = 1.0 / 240;
  JerkLimiter limiter(limits, h);
  const RandomStream draw(7);
  JerkLimiter::Velocity before;
  Eigen::Vector2d a_before = Eigen::Vector2d::Zero();
  double turn_a_before = 0, top = 0, top_turn = 0, top_a = 0;
  JerkLimiter::Velocity command;
  for (std::uint64_t i = 0; i < 400000; ++i) {
    if (i % 97 == 0 && draw.uniform(4 * i) < 0.4) command = any_velocity(draw, i, 1.0);
    const JerkLimiter::Velocity now = limiter.step(command);
    const Eigen::Vector2d a = (now.m_per_s - before.m_per_s) / h;
    const double turn_a = (now.turn_rad_per_s - before.turn_rad_per_s) / h;
    // Rounding of differences over h and h^2.
    ASSERT_LE(now.m_per_s.norm(), limits.max_velocity_m_per_s * (1 + 1e-4)) << i;
    ASSERT_LE(a.norm(), limits.max_acceleration_m_per_s2 * (1 + 1e-9)) << i;
    ASSERT_LE((a - a_before).norm() / h, *limits.max_jerk_m_per_s3 * (1 + 1e-6)) << i;
    ASSERT_LE(std::abs(now.turn_rad_per_s), limits.max_turn_rad_per_s * (1 + 1e-4)) << i;
    ASSERT_LE(std::abs(turn_a), limits.max_turn_acceleration_rad_per_s2 * (1 + 1e-9)) << i;
    ASSERT_LE(std::abs(turn_a - turn_a_before) / h, *limits.max_turn_jerk_rad_per_s3 * (1 + 1e-6))
        << i;
    top = std::max(top, now.m_per_s.norm());
    top_a = std::max(top_a, a.norm());
    top_turn = std::max(top_turn, std::abs(now.turn_rad_per_s));
    before = now;
    a_before = a;
    turn_a_before = turn_a;
  }
  EXPECT_GT(top, 0.98 * limits.max_velocity_m_per_s);  // the limits were tried
  EXPECT_GT(top_a, 0.98 * limits.max_acceleration_m_per_s2);
  EXPECT_GT(top_turn, 0.98 * limits.max_turn_rad_per_s);
}

TEST(JerkLimiter, ReachesACommandInTheTimeOfTheProfile) {
  const BaseLimits& limits = pepper().limits;
  constexpr double h = 1.0 / 240;
  JerkLimiter limiter(limits, h);
  // v / a + a / j: up with the jerk, on with the acceleration, down with the jerk.
  const double a = limits.max_acceleration_m_per_s2, j = *limits.max_jerk_m_per_s3;
  const double expected_s = 0.5 / a + a / j;
  double reached_s = 0;
  JerkLimiter::Velocity v;
  for (int i = 0; i < 1200; ++i) {
    v = limiter.step({.m_per_s = {0.5, 0}});
    if (v.m_per_s.x() < 0.5 - 1e-4) reached_s = i * h;
  }
  EXPECT_NEAR(reached_s, expected_s, 0.03);
  EXPECT_NEAR(v.m_per_s.x(), 0.5, 1e-6);
}

Trajectory straight(double length_m, int steps) {
  Trajectory base;
  for (int i = 0; i <= steps; ++i)
    base.push_back(
        {i * 33'333'333LL, SE3(Eigen::Matrix3d::Identity(), {length_m * i / steps, 0.0, 0.0})});
  return base;
}

TEST(WheelOdometry, WithoutErrorsItIsTheTruth) {
  Trajectory base;
  for (int i = 0; i <= 600; ++i) {
    const double t = i / 30.0;
    base.push_back({i * 33'333'333LL,
                    SE3(Eigen::AngleAxisd(std::sin(t), Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                        {0.3 * t, std::cos(0.7 * t), 0.0})});
  }
  const Trajectory odometry = wheel_odometry(base, wheels(), {}, 0);
  ASSERT_EQ(odometry.size(), base.size());
  for (std::size_t i = 0; i < base.size(); ++i) {
    EXPECT_LT(
        (odometry[i].world_from_camera.translation() - base[i].world_from_camera.translation())
            .norm(),
        1e-9);
    EXPECT_LT(angle_between_rad(odometry[i].world_from_camera, base[i].world_from_camera), 1e-7);
  }
}

TEST(WheelOdometry, DriftsAsConfigured) {
  const auto end = [](double length_m, const OdometryErrors& errors, std::uint64_t seed) {
    return wheel_odometry(straight(length_m, 600), wheels(), errors, seed)
        .back()
        .world_from_camera.translation();
  };
  // The scale alone: in proportion to the way.
  EXPECT_NEAR(end(10, {.scale = 0.01}, 0).x(), 10.1, 1e-9);
  EXPECT_NEAR(end(20, {.scale = 0.01}, 0).x(), 20.2, 1e-9);
  // Slip alone: along the way the two front wheels share it. A straight way of length L asks
  // L sin(61.6 deg) of each rim, so each reads an error of variance slip^2 L sin, and the way is
  // half their difference over that sine: sigma = slip sqrt(L / (2 sin)).
  const OdometryErrors slip{.slip_per_sqrt_m = 0.001};
  for (const double length_m : {5.0, 20.0}) {
    double sum = 0, square = 0;
    constexpr int kDrives = 200;
    for (std::uint64_t seed = 0; seed < kDrives; ++seed) {
      // Turning bends the way: with so little slip a second-order effect on x.
      const double error_m = end(length_m, slip, seed).x() - length_m;
      sum += error_m;
      square += error_m * error_m;
    }
    const double sigma = slip.slip_per_sqrt_m * std::sqrt(length_m / (2 * std::sin(1.07517)));
    const double measured = std::sqrt(square / kDrives - std::pow(sum / kDrives, 2));
    EXPECT_NEAR(measured / sigma, 1.0, 0.25) << length_m;  // 200 draws: 5 %
    EXPECT_LT(std::abs(sum / kDrives), 0.02 * length_m);
  }
  EXPECT_EQ(end(5, slip, 3), end(5, slip, 3));
  EXPECT_NE(end(5, slip, 3), end(5, slip, 4));
}

}  // namespace
}  // namespace mh
