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
const WheelBase& wheels() {
  return *pepper().wheels();
}

TEST(WheelBase, AheadTheFrontWheelsDriveAndTheRearOneRolls) {
  const PerWheel rims = rim_speeds_m_per_s(wheels(), {1, 0, 0});
  EXPECT_NEAR(rims[0], -std::sin(1.07517), 1e-9);  // front left
  EXPECT_NEAR(rims[1], std::sin(1.07517), 1e-9);   // front right
  EXPECT_NEAR(rims[2], 0.0, 1e-9);                 // rear
  // Turning about the center: each rim moves as fast as its wheel's place moves in its drive
  // direction.
  const PerWheel turning = rim_speeds_m_per_s(wheels(), {0, 0, 1});
  EXPECT_NEAR(turning[2], 0.170, 1e-9);
  EXPECT_NEAR(turning[0], 0.1792, 3e-4);  // its axle misses the center by 1.7 deg
  const Twist2d twist(0.2, -0.1, 0.4);
  EXPECT_TRUE(twist_of_rims(wheels(), rim_speeds_m_per_s(wheels(), twist)).isApprox(twist, 1e-12));
}

WheelBase::Wheel wheel_at(double x, double y, double axle_rad = M_PI_2) {
  return {.joint = "w", .place_m = {x, y}, .axle_rad = axle_rad};
}

WheelBase differential(std::vector<WheelBase::Wheel> wheels) {
  WheelBase base{.wheels = std::move(wheels), .radius_m = 0.033};
  EXPECT_EQ(find_kind(base), "");
  EXPECT_EQ(base.kind, WheelBase::Kind::kDifferential);
  return base;
}

TEST(WheelBase, WheelSpeedsAndMotionsAreARoundTripForThreeWheelsAndForTwo) {
  const WheelBase two = differential({wheel_at(0, 0.144), wheel_at(0, -0.144, -M_PI_2)});
  const WheelBase behind = differential({wheel_at(-0.1, 0.2), wheel_at(-0.1, -0.2)});
  const WheelBase four = differential(
      {wheel_at(0.2, 0.3), wheel_at(0.2, -0.3), wheel_at(-0.3, 0.3), wheel_at(-0.3, -0.3)});
  const RandomStream draw(2);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Twist2d any(draw.uniform(3 * i, -1, 1), draw.uniform(3 * i + 1, -1, 1),
                      draw.uniform(3 * i + 2, -2, 2));
    EXPECT_LT((twist_of_rims(wheels(), rim_speeds_m_per_s(wheels(), any)) - any).norm(), 1e-12);
    const PerWheel three = Eigen::Vector3d(any);
    EXPECT_LT((rim_speeds_m_per_s(wheels(), twist_of_rims(wheels(), three)) - three).norm(), 1e-12);
    for (const WheelBase* base : {&two, &behind, &four}) {
      const Twist2d possible = twist_of(*base, any.x(), any.z());
      EXPECT_NEAR(ahead_of(*base, possible), any.x(), 1e-15);
      const PerWheel rims = rim_speeds_m_per_s(*base, possible);
      EXPECT_LT((twist_of_rims(*base, rims) - possible).norm(), 1e-12);
      // The point midway between the wheels never moves sideways, whatever the rims do.
      const Twist2d read = twist_of_rims(*base, any.x() * rims);
      EXPECT_NEAR(read.y() + read.z() * base->middle_m.x(), 0, 1e-15);
    }
    const PerWheel both = Eigen::Vector2d(any.x(), any.y());
    EXPECT_LT((rim_speeds_m_per_s(two, twist_of_rims(two, both)) - both).norm(), 1e-12);
  }
}

TEST(WheelBase, TwoWheelsDriveAtTheirMeanAndTurnByTheirDifferenceOverTheTrack) {
  const WheelBase base = differential({wheel_at(0, 0.144), wheel_at(0, -0.144)});
  const double left = 0.10, right = 0.16, track = 0.288;
  const Twist2d read = twist_of_rims(base, Eigen::Vector2d(left, right));
  EXPECT_NEAR(read.x(), (right + left) / 2, 1e-15);
  EXPECT_EQ(read.y(), 0);
  EXPECT_NEAR(read.z(), (right - left) / track, 1e-15);
  // The axle is behind the base's origin: when the base turns left, the origin swings to the left.
  const WheelBase behind = differential({wheel_at(-0.1, 0.2), wheel_at(-0.1, -0.2)});
  EXPECT_LT((twist_of(behind, 0.3, 0.5) - Twist2d(0.3, 0.05, 0.5)).norm(), 1e-15);
  // On a skid-steered base each side moves at the mean of its wheels' speeds.
  const WheelBase four = differential(
      {wheel_at(0.2, 0.3), wheel_at(0.2, -0.3), wheel_at(-0.2, 0.3), wheel_at(-0.2, -0.3)});
  EXPECT_LT((twist_of_rims(four, Eigen::Vector4d(0.1, 0.4, 0.3, 0.8)) -
             Twist2d(0.4, 0, (0.6 - 0.2) / 0.6))
                .norm(),
            1e-15);
}

TEST(WheelBase, WheelsThatDriveNoBaseAreNamed) {
  const auto wrong = [](std::vector<WheelBase::Wheel> wheels) {
    WheelBase base{.wheels = std::move(wheels)};
    return find_kind(base);
  };
  const auto expect_in = [](const std::string& part, const std::string& text) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect_in("has 0 joints", wrong({}));
  expect_in("1 on the left", wrong({wheel_at(0, 0.2), wheel_at(0, -0.2), wheel_at(-0.2, 0)}));
  expect_in("0 on the left and 0 on the right", wrong({wheel_at(0, 0)}));
  expect_in("0 on the left and 0 on the right", wrong({wheel_at(0.2, 0.1), wheel_at(-0.2, 0.1)}));
  expect_in("has 2 joints: an omnidirectional base has three",
            wrong({wheel_at(0, 0.2), wheel_at(0, -0.2, 1.0)}));
  expect_in("not to the base's y", wrong({wheel_at(0.2, 0, 0), wheel_at(-0.2, 0, 0)}));
  // All three wheels point at the center: no rim moves when the base turns about it.
  expect_in("a direction in which no rim moves",
            wrong({wheel_at(0, 0.2, 0), wheel_at(0, -0.2, 0), wheel_at(0.3, 0, M_PI_2)}));
  EXPECT_EQ(wrong({wheel_at(0, 0.08, -1.5708), wheel_at(0, -0.08, 1.57)}),
            "");  // the angles are rounded
  WheelBase again = wheels();
  EXPECT_EQ(find_kind(again), "");
  EXPECT_EQ(again.kind, WheelBase::Kind::kOmnidirectional);
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
  EXPECT_NEAR(limiter.step({.m_per_s = {0.42, 0}}).m_per_s.x(), 0.42,
              1e-3);  // the speed is reached
  for (int i = 0; i < 2400; ++i) limiter.step({.turn_rad_per_s = 1.0});
  EXPECT_NEAR(limiter.step({.turn_rad_per_s = 1.0}).turn_rad_per_s, 1.0, 1e-3);
}

TEST(JerkLimiter, SlowsDownFromAShoveThatWasFasterThanItDrives) {
  const BaseLimits& limits = pepper().limits;
  constexpr double h = 1.0 / 240;
  for (const WheelBase* const rims : {static_cast<const WheelBase*>(nullptr), &wheels()}) {
    JerkLimiter limiter(limits, h, rims);
    limiter.stopped_at({.m_per_s = {3 * limits.max_velocity_m_per_s, 0},
                        .turn_rad_per_s = 2 * limits.max_turn_rad_per_s});
    JerkLimiter::Velocity now;
    for (int i = 0; i < 240 * 10; ++i) now = limiter.step({.m_per_s = {0.1, 0}});
    EXPECT_NEAR(now.m_per_s.x(), 0.1, 1e-6);
    EXPECT_NEAR(now.turn_rad_per_s, 0, 1e-6);
  }
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
    // The factors allow for rounding of differences divided by h and h^2.
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
  EXPECT_GT(top, 0.98 * limits.max_velocity_m_per_s);  // the limits were put to the test
  EXPECT_GT(top_a, 0.98 * limits.max_acceleration_m_per_s2);
  EXPECT_GT(top_turn, 0.98 * limits.max_turn_rad_per_s);
}

TEST(JerkLimiter, WithoutALimitOfJerkItKeepsTheOthersAndReachesTheCommand) {
  constexpr double h = 1.0 / 240;
  BaseLimits limits = pepper().limits;
  limits.max_jerk_m_per_s3 = limits.max_turn_jerk_rad_per_s3 = {};
  JerkLimiter limiter(limits, h, &wheels());
  JerkLimiter::Velocity before, now;
  double reached_s = 0;
  for (int i = 0; i < 480; ++i) {
    now = limiter.step({.m_per_s = {0.3, 0}, .turn_rad_per_s = -0.5});
    EXPECT_LE((now.m_per_s - before.m_per_s).norm(),
              limits.max_acceleration_m_per_s2 * h * (1 + 1e-9));
    if (now.m_per_s.x() < 0.3 - 1e-9) reached_s = i * h;
    before = now;
  }
  EXPECT_NEAR(reached_s, 0.3 / limits.max_acceleration_m_per_s2, 2 * h);
  EXPECT_NEAR(now.m_per_s.x(), 0.3, 1e-9);
  EXPECT_NEAR(now.turn_rad_per_s, -0.5, 1e-9);
}

TEST(JerkLimiter, ReachesACommandInTheTimeOfTheProfile) {
  const BaseLimits& limits = pepper().limits;
  constexpr double h = 1.0 / 240;
  JerkLimiter limiter(limits, h);
  // v / a + a / j: the acceleration rises at the jerk limit, stays at its own limit, and falls at
  // the jerk limit.
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

TEST(WheelOdometry, OfTwoWheelsItIsTheTruthWithoutErrorsAndBendsIfOneWheelIsLarger) {
  const WheelBase base = differential({wheel_at(-0.05, 0.144), wheel_at(-0.05, -0.144)});
  const auto drive = [&](double turn_per_step) {
    Trajectory path{{0, SE3()}};
    for (int i = 1; i <= 300; ++i) {
      const Twist2d moved = twist_of(base, 0.01, turn_per_step * std::sin(0.02 * i));
      Vector6d step = Vector6d::Zero();
      step << moved.x(), moved.y(), 0, 0, 0, moved.z();
      path.push_back({i * 33'333'333LL, path.back().world_from_camera * SE3::exp(step)});
    }
    return path;
  };
  const Trajectory truth = drive(0.05);
  const Trajectory odometry = wheel_odometry(truth, base, {}, 0);
  ASSERT_EQ(odometry.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const SE3 error = truth[i].world_from_camera.inverse() * odometry[i].world_from_camera;
    EXPECT_LT(error.log().norm(), 1e-9);
  }
  // A straight drive whose wheels read with scales l and r is measured as an arc of (r - l) / track
  // per meter.
  const SE3 end =
      wheel_odometry(drive(0), base, {.scale_spread = 0.01}, 5).back().world_from_camera;
  const double turned = Eigen::Rotation2Dd(end.rotation().topLeftCorner<2, 2>()).angle();
  EXPECT_GT(std::abs(turned), 0.005);
  EXPECT_NEAR(end.translation().head<2>().norm(), 3, 0.1);
}

TEST(WheelOdometry, DriftsAsConfigured) {
  const auto end = [](double length_m, const OdometryErrors& errors, std::uint64_t seed) {
    return wheel_odometry(straight(length_m, 600), wheels(), errors, seed)
        .back()
        .world_from_camera.translation();
  };
  // Scale only: the error is proportional to the path.
  EXPECT_NEAR(end(10, {.scale = 0.01}, 0).x(), 10.1, 1e-9);
  EXPECT_NEAR(end(20, {.scale = 0.01}, 0).x(), 20.2, 1e-9);
  // Slip only: the two front wheels share the motion along the path. A straight path of length L
  // needs L sin(61.6 deg) from each rim, so each reading has an error variance of slip^2 L sin(61.6
  // deg), and the measured path is half the difference of the readings divided by the sine: sigma =
  // slip sqrt(L / (2 sin)).
  const OdometryErrors slip{.slip_per_sqrt_m = 0.001};
  for (const double length_m : {5.0, 20.0}) {
    double sum = 0, square = 0;
    constexpr int kDrives = 200;
    for (std::uint64_t seed = 0; seed < kDrives; ++seed) {
      // Turning bends the path: a second-order effect on x with so little slip.
      const double error_m = end(length_m, slip, seed).x() - length_m;
      sum += error_m;
      square += error_m * error_m;
    }
    const double sigma = slip.slip_per_sqrt_m * std::sqrt(length_m / (2 * std::sin(1.07517)));
    const double measured = std::sqrt(square / kDrives - std::pow(sum / kDrives, 2));
    EXPECT_NEAR(measured / sigma, 1.0, 0.25) << length_m;  // with 200 samples: 5 %
    EXPECT_LT(std::abs(sum / kDrives), 0.02 * length_m);
  }
  EXPECT_EQ(end(5, slip, 3), end(5, slip, 3));
  EXPECT_NE(end(5, slip, 3), end(5, slip, 4));
}

}  // namespace
}  // namespace mh
