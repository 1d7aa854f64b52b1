// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/reference.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

constexpr double h = 1.0 / 240;

/// First, second and third differences of the base's positions and headings; it is at rest before
/// and after.
DrivePeaks differences(const Stretch& stretch) {
  const auto n = static_cast<long>(stretch.position_m.size());
  const auto p = [&](long i) {
    const auto k = static_cast<std::size_t>(std::clamp(i, 0L, n - 1));
    return Eigen::Vector3d(stretch.position_m[k].x(), stretch.position_m[k].y(),
                           stretch.heading_rad[k]);
  };
  DrivePeaks peaks;
  for (long i = -3; i < n; ++i) {
    const Eigen::Vector3d v = (p(i + 1) - p(i)) / h;
    const Eigen::Vector3d a = (p(i + 2) - 2 * p(i + 1) + p(i)) / (h * h);
    const Eigen::Vector3d j = (p(i + 3) - 3 * p(i + 2) + 3 * p(i + 1) - p(i)) / (h * h * h);
    peaks.m_per_s = std::max(peaks.m_per_s, v.head<2>().norm());
    peaks.m_per_s2 = std::max(peaks.m_per_s2, a.head<2>().norm());
    peaks.m_per_s3 = std::max(peaks.m_per_s3, j.head<2>().norm());
    peaks.rad_per_s = std::max(peaks.rad_per_s, std::abs(v.z()));
    peaks.rad_per_s2 = std::max(peaks.rad_per_s2, std::abs(a.z()));
    peaks.rad_per_s3 = std::max(peaks.rad_per_s3, std::abs(j.z()));
  }
  return peaks;
}

/// Full acceleration in random directions, and back to rest.
Stretch restless(double acceleration, double turn_acceleration) {
  const RandomStream draw(3);
  Stretch stretch;
  Eigen::Vector2d p(5, -3), v(0, 0);
  double heading = 1, w = 0;
  const auto note = [&] {
    stretch.position_m.push_back(p);
    stretch.heading_rad.push_back(heading);
    stretch.waypoint.push_back(0);
  };
  note();
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const double way = draw.uniform(2 * (i / 60), -M_PI, M_PI);
    v += h * acceleration * Eigen::Vector2d(std::cos(way), std::sin(way));
    w += h * std::copysign(turn_acceleration, draw.uniform(2 * (i / 45) + 1, -1, 1));
    p += h * v;
    heading += h * w;
    note();
  }
  while (v.norm() > 0 || w != 0) {
    v *= std::max(0.0, 1 - h * acceleration / std::max(v.norm(), 1e-12));
    w -= std::clamp(w, -h * turn_acceleration, h * turn_acceleration);
    p += h * v;
    heading += h * w;
    note();
  }
  return stretch;
}

TEST(Smoothed, KeepsTheJerkAndNeitherGrowsAnythingNorStraysFar) {
  const BaseLimits limits = test::pepper().limits;
  const Stretch raw = restless(0.5, 0.7), smooth = smoothed(raw, limits, h);
  const DrivePeaks before = differences(raw), after = differences(smooth);
  EXPECT_GT(before.m_per_s3, 10.0);  // the input exceeds the jerk limit
  EXPECT_LE(after.m_per_s3, *limits.max_jerk_m_per_s3);
  EXPECT_LE(after.rad_per_s3, *limits.max_turn_jerk_rad_per_s3);
  EXPECT_LE(after.m_per_s, before.m_per_s);
  EXPECT_LE(after.m_per_s2, before.m_per_s2 + 1e-9);
  EXPECT_LE(after.rad_per_s, before.rad_per_s);
  EXPECT_LE(after.rad_per_s2, before.rad_per_s2 + 1e-9);
  EXPECT_LT((smooth.position_m.front() - raw.position_m.front()).norm(), 1e-12);
  EXPECT_LT((smooth.position_m.back() - raw.position_m.back()).norm(), 1e-12);
  EXPECT_NEAR(smooth.heading_rad.back(), raw.heading_rad.back(), 1e-12);
  // At most 2 A / j = 1.05 s longer, and off by at most A T^2 / 24.
  const auto longer = static_cast<long>(smooth.position_m.size() - raw.position_m.size());
  const double window_s = static_cast<double>(longer + 1) * h;
  EXPECT_LE(window_s, 2 * 0.5 / (0.95 * *limits.max_jerk_m_per_s3) + h);
  for (long i = 0; i < static_cast<long>(smooth.position_m.size()); ++i) {
    const auto k = static_cast<std::size_t>(
        std::clamp(i - longer / 2, 0L, static_cast<long>(raw.position_m.size()) - 1));
    ASSERT_LT((smooth.position_m[static_cast<std::size_t>(i)] - raw.position_m[k]).norm(),
              0.5 * window_s * window_s / 24 + before.m_per_s * h)  // plus half a step of rounding
        << i;
  }
}

TEST(Smoothed, WithoutALimitOfJerkItIsAsItWas) {
  const Stretch raw = restless(0.5, 0.7);
  const Stretch same = smoothed(raw, {}, h);
  EXPECT_EQ(same.position_m, raw.position_m);
  EXPECT_EQ(same.heading_rad, raw.heading_rad);
}

TEST(ReferenceMotion, KeepsEveryLimitThroughBowsStopsAndTurns) {
  Tour tour;
  tour.name = "test";
  for (const auto& [x, y] : {std::pair{4.0, 0.0}, {4.0, 3.0}, {3.6, 3.2}, {3.5, 2.9}, {0.0, 2.0}})
    tour.waypoints.push_back({.position_m = {x, y}});
  tour.waypoints[1].look_at_m = Eigen::Vector2d(4.2, 2.8);  // it swings around in passing
  tour.waypoints[4].turn_rad = -7;
  tour.waypoints.push_back({.position_m = {0, 2}, .pause_s = 1});
  tour.waypoints.push_back({.position_m = {0.02, 2.0}, .heading_rad = 1.0});
  const BaseLimits limits = test::pepper().limits;
  const std::vector<Stretch> stretches = reference_motion(tour, limits, h);
  ASSERT_GE(stretches.size(), 5U);
  Stretch whole;  // stretches follow each other without a gap
  for (const Stretch& stretch : stretches) {
    whole.position_m.insert(whole.position_m.end(), stretch.position_m.begin() + 1,
                            stretch.position_m.end());
    whole.heading_rad.insert(whole.heading_rad.end(), stretch.heading_rad.begin() + 1,
                             stretch.heading_rad.end());
  }
  const DrivePeaks peaks = differences(whole);
  EXPECT_LE(peaks.m_per_s, limits.max_velocity_m_per_s);
  EXPECT_LE(peaks.m_per_s2, limits.max_acceleration_m_per_s2);
  EXPECT_LE(peaks.m_per_s3, *limits.max_jerk_m_per_s3);
  EXPECT_LE(peaks.rad_per_s, limits.max_turn_rad_per_s);
  EXPECT_LE(peaks.rad_per_s2, limits.max_turn_acceleration_rad_per_s2);
  EXPECT_LE(peaks.rad_per_s3, *limits.max_turn_jerk_rad_per_s3);
  EXPECT_GT(peaks.m_per_s, 0.9 * limits.max_velocity_m_per_s);  // no slower than necessary
  EXPECT_GT(peaks.m_per_s3, 0.9 * *limits.max_jerk_m_per_s3);
  EXPECT_GT(peaks.rad_per_s3, 0.9 * *limits.max_turn_jerk_rad_per_s3);
  EXPECT_LT((whole.position_m.front() - tour.start_m).norm(), 1e-12);
  EXPECT_LT((whole.position_m.back() - Eigen::Vector2d(0.02, 2)).norm(), 1e-12);
  EXPECT_NEAR(std::remainder(whole.heading_rad.back() - 1.0, 2 * M_PI), 0, 1e-12);
  EXPECT_EQ(stretches.back().waypoint.back(), 6U);
}

}  // namespace
}  // namespace mh
