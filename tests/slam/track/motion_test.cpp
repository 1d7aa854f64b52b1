// SPDX-License-Identifier: Apache-2.0
#include "slam/track/motion.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

constexpr double kFrame_s = 1.0 / 30;

Matrix6d diagonal(double position_m, double angle_rad) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(position_m * position_m),
      Eigen::Vector3d::Constant(angle_rad * angle_rad);
  return variances.asDiagonal();
}

TEST(Motion, FindsASteadyVelocityAndFollowsItUnseen) {
  Vector6d velocity_per_s;
  velocity_per_s << 0.3, -0.1, 0.2, 0.1, 0.8, -0.2;
  const Matrix6d covariance = diagonal(1e-4, 1e-4);
  const auto pose_at = [&](int frame) { return SE3::exp(velocity_per_s * frame * kFrame_s); };
  Motion motion = Motion::at_rest(covariance);
  for (int i = 1; i < 20; ++i) {
    const SE3 predicted = motion.predict(pose_at(i - 1), kFrame_s);
    motion = motion.after(kFrame_s);
    motion.correct((pose_at(i) * predicted.inverse()).log(), covariance);
  }
  EXPECT_LT((motion.velocity_per_s - velocity_per_s).norm(), 1e-6);
  const SE3 error = motion.predict(pose_at(19), 6 * kFrame_s) * pose_at(25).inverse();
  EXPECT_LT(error.log().norm(), 1e-6);
}

TEST(Motion, UnseenItGrowsLessSureFasterAndFaster) {
  Motion motion = Motion::at_rest(diagonal(1e-3, 1e-3));
  for (int i = 0; i < 30; ++i) {
    motion = motion.after(kFrame_s);
    motion.correct(Vector6d::Zero(), diagonal(1e-3, 1e-3));
  }
  double before = 0, grown_before = 0;
  for (int i = 1; i <= 10; ++i) {
    const double sigma = worst_sigma(motion.after(i * kFrame_s).pose_covariance).position_m;
    if (i > 1) {
      EXPECT_GT(sigma - before, grown_before) << i;
      grown_before = sigma - before;
    }
    before = sigma;
  }
  // One step of 0.2 s equals six steps of a thirtieth of a second.
  Motion six = motion;
  for (int i = 0; i < 6; ++i) six = six.after(kFrame_s);
  EXPECT_LT((six.pose_covariance - motion.after(6 * kFrame_s).pose_covariance).norm(), 1e-12);
}

TEST(Motion, ItsCovarianceIsThatOfItsErrors) {
  // A camera with random accelerations of the size that the filter assumes, observed with varying
  // noise.
  constexpr int kRuns = 200, kFrames = 40;
  const double shift = std::sqrt(kFrame_s / 30), turn = std::sqrt(9 * kFrame_s / 30);
  double squared = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const RandomStream random(run);
    Vector6d pose = Vector6d::Zero(), velocity = Vector6d::Zero(), best = Vector6d::Zero();
    Motion motion = Motion::at_rest(diagonal(1e-6, 1e-6));
    for (std::uint64_t i = 1; i <= kFrames; ++i) {
      const RandomStream draws = random.fork(i);
      const double noise = i % 7 == 0 ? 0.02 : 0.002;
      Vector6d seen;
      for (int k = 0; k < 6; ++k) {
        const auto axis = static_cast<std::uint64_t>(k);
        const double push = (k < 3 ? shift : turn) * draws.normal(axis);
        // The displacement by white acceleration in one step: half of the velocity change, and an
        // independent part of the same origin.
        pose[k] += kFrame_s * (velocity[k] + 0.5 * push) +
                   kFrame_s / std::sqrt(12.0) * (k < 3 ? shift : turn) * draws.normal(6 + axis);
        velocity[k] += push;
        seen[k] = pose[k] + noise * draws.normal(12 + axis);
      }
      best += kFrame_s * motion.velocity_per_s;
      motion = motion.after(kFrame_s);
      best += motion.correct(seen - best, diagonal(noise, noise));
    }
    const Vector6d error = pose - best;
    squared += error.dot(motion.pose_covariance.llt().solve(error)) / kRuns;
  }
  // Chi-square with 6 degrees of freedom has a mean of 6; the mean of 200 samples has a standard
  // error of 0.245.
  EXPECT_NEAR(squared, 6, 3 * 0.245);
}

TEST(Motion, WhatIsUnsureAlongOneAxisMovesItAlongTheOthers) {
  Motion motion = Motion::at_rest(diagonal(1e-3, 1e-3)).after(1e-3);
  Matrix6d covariance = diagonal(1e-4, 1e-4);
  covariance(0, 0) = 1;  // m^2
  Vector6d seen_off = Vector6d::Constant(0.01);
  const Vector6d off = motion.correct(seen_off, covariance);
  EXPECT_LT(std::abs(off[0]), 1e-3);
  for (int k = 1; k < 6; ++k) EXPECT_NEAR(off[k], 0.01, 1e-3) << k;
}

TEST(WorstSigma, IsTheLongestAxisOfEachBlock) {
  Matrix6d covariance = diagonal(0.01, 0.02);
  covariance(0, 1) = covariance(1, 0) = 0.5e-4;  // the axes are sqrt(1.5e-4) and sqrt(0.5e-4)
  const PoseSigma sigma = worst_sigma(covariance);
  EXPECT_NEAR(sigma.position_m, std::sqrt(1.5e-4), 1e-12);
  EXPECT_NEAR(sigma.angle_rad, 0.02, 1e-12);
}

}  // namespace
}  // namespace mh
