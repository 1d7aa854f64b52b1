// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/imu.hpp"

#include <gtest/gtest.h>

#include "slam/core/imu.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;

ImuConfig exact() {
  return {.rate_hz = 200,
          .gyro_noise = 0,
          .gyro_walk = 0,
          .gyro_bias = 0,
          .accel_noise = 0,
          .accel_walk = 0,
          .accel_bias = 0};
}

/// A path at 30 Hz: waves of 0.3 m and 0.6 rad while it turns.
Trajectory a_path(std::size_t frames = 300) {
  Trajectory path;
  for (std::size_t i = 0; i < frames; ++i) {
    const double t = static_cast<double>(i) / 30;
    const Vector3d place(0.5 * t, 0.3 * std::sin(2 * t), 0.1 * std::cos(3 * t));
    const Eigen::Matrix3d turned =
        so3_exp({0.6 * std::sin(1.5 * t), 0, 0}) * so3_exp({0, 0.8 * t, 0.2 * std::cos(t)});
    path.push_back({1'000'000'000 + static_cast<Stamp>(std::llround(t * 1e9)), {turned, place}});
  }
  return path;
}

// At rest the accelerometer measures the force that supports it, and the gyroscope nothing.
TEST(Imu, AtRestFeelsGravityAlone) {
  const Eigen::Matrix3d tilted = so3_exp({0.3, -0.4, 0.2});
  Trajectory path;
  for (int i = 0; i < 30; ++i) path.push_back({i * 33'333'333, {tilted, {1, 2, 3}}});
  const auto readings = imu_along(path, exact(), RandomStream(1)).readings;
  ASSERT_EQ(readings.size(), 194u);  // 29 steps of 1/30 s at 200 Hz
  for (const ImuReading& r : readings) {
    EXPECT_LT(r.turn_rad_per_s.norm(), 1e-12);
    EXPECT_LT((tilted * r.specific_force_m_per_s2 - Vector3d(0, 0, 9.81)).norm(), 1e-9);
  }
}

// Integrating the readings gives the path: the rotation and, after removing gravity, the position,
// over 10 s from the true start.
TEST(Imu, IntegratesToThePath) {
  const Trajectory path = a_path();
  const double period_s = 1.0 / 2000;
  ImuConfig fine = exact();
  fine.rate_hz = 2000;
  const ImuPath truth = imu_along(path, fine, RandomStream(1));
  const std::vector<ImuReading>& readings = truth.readings;
  Eigen::Matrix3d rotation = path.front().world_from_camera.rotation();
  Vector3d place = path.front().world_from_camera.translation();
  ASSERT_EQ(truth.velocities_m_per_s.size(), path.size());
  Vector3d velocity = truth.velocities_m_per_s.front();
  EXPECT_LT((velocity - Vector3d(0.5, 0.6, 0)).norm(), 0.02) << "of a_path() at 0";
  for (const ImuReading& r : readings) {
    const bool is_end = &r == &readings.front() || &r == &readings.back();
    const double t_s = is_end ? period_s / 2 : period_s;
    const Eigen::Matrix3d middle = rotation * so3_exp(r.turn_rad_per_s * t_s / 2);
    const Vector3d acceleration = middle * r.specific_force_m_per_s2 - Vector3d(0, 0, 9.81);
    place += velocity * t_s + acceleration * t_s * t_s / 2;
    velocity += acceleration * t_s;
    rotation = rotation * so3_exp(r.turn_rad_per_s * t_s);
  }
  const SE3& end = path.back().world_from_camera;
  EXPECT_LT(so3_log(rotation.transpose() * end.rotation()).norm(), 1e-3);
  EXPECT_LT((place - end.translation()).norm(), 0.02);
  EXPECT_LT((truth.velocities_m_per_s.back() - velocity).norm(), 0.01);
}

TEST(Imu, TurnsByThePathsRotationBetweenAnyTwoPoses) {
  const Trajectory path = a_path(60);
  const auto readings = imu_along(path, exact(), RandomStream(1)).readings;
  double worst_rad_per_s = 0;
  for (const ImuReading& r : readings) {
    // The expected rate is computed by finite differences from a_path()'s own formula.
    const double t = static_cast<double>(r.stamp_ns - 1'000'000'000) * 1e-9, h = 1e-5;
    if (t < 0.1 || t > 1.8) continue;
    const auto rotation = [](double s) -> Eigen::Matrix3d {
      return so3_exp({0.6 * std::sin(1.5 * s), 0, 0}) * so3_exp({0, 0.8 * s, 0.2 * std::cos(s)});
    };
    const Vector3d turn = so3_log(rotation(t - h).transpose() * rotation(t + h)) / (2 * h);
    worst_rad_per_s = std::max(worst_rad_per_s, (turn - r.turn_rad_per_s).norm());
  }
  EXPECT_LT(worst_rad_per_s, 2e-3);
}

TEST(Imu, ErrsByItsNoiseBiasAndWalk) {
  Trajectory path;
  for (int i = 0; i < 3000; ++i) path.push_back({i * 33'333'333LL, SE3()});
  const auto spread = [&](const ImuConfig& config) {
    const auto readings = imu_along(path, config, RandomStream(4)).readings;
    double sum = 0;
    for (const ImuReading& r : readings) sum += r.turn_rad_per_s.squaredNorm() / 3;
    return std::sqrt(sum / static_cast<double>(readings.size()));
  };
  ImuConfig white = exact();
  white.gyro_noise = 1e-3;
  EXPECT_NEAR(spread(white), 1e-3 * std::sqrt(200.0), 2e-4);
  ImuConfig walks = exact();
  walks.gyro_walk = 1e-3;  // 1e-2 after 100 s; rms over them 7e-3
  EXPECT_GT(spread(walks), 2e-3);
  EXPECT_LT(spread(walks), 2e-2);
  ImuConfig biased = exact();
  biased.accel_bias = 0.1;
  const auto readings = imu_along(path, biased, RandomStream(4)).readings;
  const Vector3d bias = readings.front().specific_force_m_per_s2 - Vector3d(0, 0, 9.81);
  EXPECT_GT(bias.norm(), 0.01);
  EXPECT_LT(bias.norm(), 0.4);
  EXPECT_LT((readings.back().specific_force_m_per_s2 - Vector3d(0, 0, 9.81) - bias).norm(), 1e-9);
  // Equal streams give equal bits; a different stream gives a different bias.
  EXPECT_EQ(imu_along(path, biased, RandomStream(4)).readings, readings);
  EXPECT_NE(imu_along(path, biased, RandomStream(5)).readings, readings);
  // The truth contains the errors of the readings.
  const ImuPath truth = imu_along(path, {}, RandomStream(4));
  ASSERT_EQ(truth.biases.size(), truth.readings.size());
  Vector3d off = Vector3d::Zero();
  for (std::size_t k = 0; k < truth.readings.size(); ++k)
    off += truth.readings[k].turn_rad_per_s - truth.biases[k].turn_rad_per_s;
  EXPECT_LT(off.norm() / static_cast<double>(truth.readings.size()), 1e-4);
}

TEST(Imu, ReadingsBetweenTwoMomentsBelongToTheLater) {
  std::vector<ImuReading> readings(5);
  for (std::size_t i = 0; i < 5; ++i) readings[i].stamp_ns = static_cast<Stamp>(10 * i);
  const auto two = imu_between(readings, 10, 30);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two.front().stamp_ns, 20);
  EXPECT_TRUE(imu_between(readings, 30, 10).empty());
  EXPECT_TRUE(imu_between(readings, 41, 100).empty());
  EXPECT_EQ(imu_between(readings, -1, 100).size(), 5u);
}

}  // namespace
}  // namespace mh
