// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/path.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace mh {
namespace {

const std::array<Eigen::Vector2d, 4> kCorners{Eigen::Vector2d{0, 0}, {3, 0}, {3, 2}, {4.5, 3}};

TEST(RoundedPath, ARightAngleBecomesAQuarterCircle) {
  const std::array<Eigen::Vector2d, 3> corners{Eigen::Vector2d{0, 0}, {3, 0}, {3, 2}};
  const RoundedPath path(corners, {.cut_m = 0.5});
  EXPECT_NEAR(path.length_m(), 2.5 + 0.5 * M_PI_2 + 1.5, 1e-12);
  EXPECT_NEAR(path.at(2.6).curvature_per_m, 2.0, 1e-12);
  const Eigen::Vector2d middle(2.5 + 0.5 * std::sqrt(0.5), 0.5 - 0.5 * std::sqrt(0.5));
  EXPECT_LT((path.at(path.corner_s_m(1)).position_m - middle).norm(), 1e-12);
}

TEST(RoundedPath, IsContinuousWithUnitSpeedAndContinuousTangent) {
  const RoundedPath path(kCorners);
  constexpr double h = 1e-4;
  for (double s = -0.5; s < path.length_m() + 0.5; s += h) {
    const PathPoint a = path.at(s), b = path.at(s + h);
    ASSERT_NEAR((b.position_m - a.position_m).norm(), h, 1e-9) << s;
    ASSERT_LT((b.direction - a.direction).norm(), h / 0.3) << s;  // no curve is tighter than 0.3 m
    ASSERT_LT((b.position_m - a.position_m - h * a.direction).norm(), 1e-7) << s;
  }
  EXPECT_LT((path.at(0).position_m - kCorners.front()).norm(), 1e-12);
  EXPECT_LT((path.at(path.length_m()).position_m - kCorners.back()).norm(), 1e-12);
}

TEST(SpeedProfile, NeverAsksForMoreThanTheLimits) {
  const RoundedPath path(kCorners);
  const SpeedLimits limits{.velocity_m_per_s = 0.55, .along_m_per_s2 = 0.4, .across_m_per_s2 = 0.3};
  const SpeedProfile profile(path, limits);
  constexpr double h = 0.01;
  double top = 0;
  for (double s = 0; s + h < path.length_m(); s += h) {
    const double v = profile.at(s), next = profile.at(s + h);
    ASSERT_LE(v, limits.velocity_m_per_s + 1e-12);
    ASSERT_LE(std::abs(v * v - next * next) / (2 * h), limits.along_m_per_s2 + 1e-9) << s;
    ASSERT_LE(v * v * std::abs(path.at(s).curvature_per_m), limits.across_m_per_s2 + 1e-9) << s;
    top = std::max(top, v);
  }
  EXPECT_DOUBLE_EQ(top, limits.velocity_m_per_s);
  EXPECT_EQ(profile.at(0), 0.0);
  EXPECT_EQ(profile.at(path.length_m()), 0.0);
}

TEST(SpeedProfile, TimeAndPlaceAgreeWithTheSpeed) {
  const RoundedPath path(kCorners);
  const SpeedProfile profile(
      path, {.velocity_m_per_s = 0.55, .along_m_per_s2 = 0.4, .across_m_per_s2 = 0.3});
  constexpr double h = 1e-3;
  for (double t = 0; t + h < profile.duration_s(); t += h) {
    const double s = profile.s_at(t), ds = profile.s_at(t + h) - s;
    ASSERT_NEAR(ds / h, profile.at(s + 0.5 * ds), 0.4 * h) << t;
  }
  EXPECT_EQ(profile.s_at(0), 0.0);
  EXPECT_NEAR(profile.s_at(profile.duration_s()), path.length_m(), 1e-12);
  EXPECT_NEAR(profile.s_at(1e3), path.length_m(), 1e-12);
  // A straight path: v / a each to speed up and to slow down, the rest at v.
  const std::array<Eigen::Vector2d, 2> line{Eigen::Vector2d{0, 0}, {3, 0}};
  const SpeedProfile straight(
      RoundedPath(line), {.velocity_m_per_s = 0.5, .along_m_per_s2 = 0.4, .across_m_per_s2 = 0.3});
  EXPECT_NEAR(straight.duration_s(), 3 / 0.5 + 0.5 / 0.4,
              0.01);  // the speed changes abruptly within 1 cm
}

}  // namespace
}  // namespace mh
