// SPDX-License-Identifier: Apache-2.0
#include "slam/track/inertial.hpp"

#include <gtest/gtest.h>

#include "sim/sensors/imu.hpp"
#include "slam/core/imu.hpp"
#include "slam/pipeline/slam.hpp"
#include "source_dir.hpp"
#include "tests/slam/pipeline/feature_world.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;
using testing_support::FeatureWorld;

constexpr Stamp kStep_ns = 33'333'333;

/// The path of a handheld camera at 30 Hz, in a world whose z is up.
Trajectory handheld(std::size_t frames) {
  Trajectory path;
  for (std::size_t i = 0; i < frames; ++i) {
    const double t = static_cast<double>(i) / 30;
    const Vector3d place(0.4 * t, 0.3 * std::sin(1.1 * t), 1.4 + 0.05 * std::sin(4 * t));
    const Eigen::Matrix3d turned =
        so3_exp({0, 0, 0.7 * std::sin(0.8 * t)}) * so3_exp({-1.7 + 0.2 * std::sin(1.3 * t), 0, 0});
    path.push_back({kStep_ns * static_cast<Stamp>(i), {turned, place}});
  }
  return path;
}

/// The filter, given true poses with errors of 2 mm and 2 mrad.
struct Fed {
  Trajectory path = handheld(400);
  std::vector<ImuReading> imu = imu_along(path, {}, RandomStream(7)).readings;
  Matrix6d measured = Matrix6d::Identity() * 4e-6;
  InertialMotion motion = InertialMotion::begin(imu.front(), measured, camera_from_world(0), {});

  SE3 camera_from_world(std::size_t i) const { return path[i].world_from_camera.inverse(); }
  SE3 advance(std::size_t from, std::size_t to) {
    const Stamp from_ns = path[from].stamp_ns, to_ns = path[to].stamp_ns;
    const auto moved = motion.advance(imu_between(imu, from_ns, to_ns), from_ns, to_ns);
    EXPECT_TRUE(moved);
    return *moved;
  }
  void see(std::size_t until) {
    SE3 at = camera_from_world(0);
    for (std::size_t i = 1; i <= until; ++i) {
      const SE3 predicted = advance(i - 1, i) * at;
      Vector6d noise;
      for (std::uint64_t k = 0; k < 6; ++k)
        noise[static_cast<int>(k)] = 0.002 * RandomStream(9).fork(i).normal(k);
      at = SE3::exp(noise) * camera_from_world(i);
      motion.correct((at * predicted.inverse()).log(), measured);
    }
  }
};

TEST(InertialMotion, LearnsVelocityGravityAndTheGyroscopesBias) {
  Fed fed;
  fed.see(300);
  const SE3& here = fed.path[300].world_from_camera;
  const Vector3d velocity = here.rotation().transpose() *
                            (fed.path[301].world_from_camera.translation() -
                             fed.path[299].world_from_camera.translation()) *
                            15;
  EXPECT_LT((fed.motion.velocity_m_per_s - velocity).norm(), 0.03);
  const Vector3d down = here.rotation().transpose() * Vector3d(0, 0, -9.81);
  EXPECT_LT((fed.motion.gravity_m_per_s2 - down).norm(), 0.2);
  const Vector3d bias = imu_along(fed.path, {}, RandomStream(7)).biases[2000].turn_rad_per_s;
  EXPECT_GT(bias.norm(), 0.005) << "nothing to learn";
  EXPECT_LT((fed.motion.turn_bias_rad_per_s - bias).norm(), 0.2 * bias.norm());
}

// After one second and after three seconds without any image, the error matches the filter's
// covariance.
TEST(InertialMotion, CarriesThePoseAcrossABlindSpell) {
  for (const std::size_t blind : {30U, 90U}) {
    Fed fed;
    fed.see(300);
    const SE3 carried = fed.advance(300, 300 + blind) * fed.camera_from_world(300);
    const Vector6d off = (carried * fed.camera_from_world(300 + blind).inverse()).log();
    EXPECT_LT(off.head<3>().norm(), blind == 30 ? 0.03 : 0.25);
    EXPECT_LT(off.tail<3>().norm(), 0.01);
    const Matrix6d covariance = fed.motion.pose_covariance();
    EXPECT_LT(off.dot(covariance.ldlt().solve(off)), 20) << "6 degrees of freedom";
    EXPECT_LT(std::sqrt(covariance.diagonal().head<3>().maxCoeff()), blind == 30 ? 0.1 : 0.5);
  }
}

TEST(InertialMotion, WhatItKnowsBeginsItAnewElsewhere) {
  Fed fed;
  fed.see(300);
  const SE3 here = fed.camera_from_world(300), there = fed.camera_from_world(350);
  const auto anew =
      InertialMotion::begin(fed.imu.front(), fed.measured, there, fed.motion.known(here));
  const Vector3d down = there.rotation() * Vector3d(0, 0, -9.81);
  EXPECT_LT((anew.gravity_m_per_s2 - down).norm(), 0.2);
  EXPECT_EQ(anew.turn_bias_rad_per_s, fed.motion.turn_bias_rad_per_s);
  const Matrix18d& before = fed.motion.covariance;
  const double learned = before.bottomRightCorner<9, 9>().trace();
  EXPECT_NEAR(anew.covariance.trace(), learned + 6 * 4e-6 + 3 * 4, 1e-9);
}

TEST(InertialMotion, AGapInTheReadingsEndsIt) {
  Fed fed;
  fed.see(10);
  EXPECT_FALSE(fed.motion.advance({}, fed.path[10].stamp_ns, fed.path[20].stamp_ns));
}

/// A walk through two rooms; the camera sees nothing for a second of its first full turn. The row
/// of rooms is level.
TEST(Imu, CarriesTheMapAcrossABlindSpell) {
  static const FeatureWorld row(2500, 400);
  static const auto vocabulary = std::make_shared<const Vocabulary>(
      Vocabulary::load(std::string(MH_SOURCE_DIR) + "/assets/vocabulary.mhvoc"));
  const auto walk = FeatureWorld::there_and_back(0, 1);
  Trajectory path;
  for (std::size_t i = 0; i < 140; ++i)
    path.push_back({kStep_ns * static_cast<Stamp>(i + 1), walk[i]});
  const std::vector<ImuReading> imu = imu_along(path, {}, RandomStream(5)).readings;
  const auto lost_with = [&](double reckon_position_m) {
    SlamConfig config;
    config.features.count = 400;
    config.track.reckon_position_m = reckon_position_m;
    SlamState state = make_slam(FeatureWorld::camera(), config, vocabulary);
    int lost = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const bool blind = i >= 80 && i < 110;
      const StepReport report = step(
          state, path[i].stamp_ns, blind ? Features() : row.see(walk[i], RandomStream(2).fork(i)),
          RandomStream(3).fork(i), {}, {},
          imu_between(imu, i == 0 ? 0 : path[i - 1].stamp_ns, path[i].stamp_ns));
      lost += report.status == TrackStatus::kLost;
      if (!report.world_from_camera) continue;
      const SE3 error = report.world_from_camera->inverse() * walk.front().inverse() * walk[i];
      EXPECT_LT(error.translation().norm(), 0.1) << i;
      EXPECT_LT(error.log().tail<3>().norm(), 0.03) << i;
    }
    return lost;
  };
  EXPECT_EQ(lost_with(0.3), 0);
  EXPECT_GT(lost_with(0), 20);
}

}  // namespace
}  // namespace mh
