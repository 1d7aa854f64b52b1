// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "sim/motion/motion.hpp"

namespace mh::test {

/// Expects that the base, as moved by Bullet, kept every limit.
inline void expect_limits_kept(const DrivePeaks& peaks, const BaseLimits& limits) {
  EXPECT_LE(peaks.m_per_s, limits.max_velocity_m_per_s);
  EXPECT_LE(peaks.rad_per_s, limits.max_turn_rad_per_s);
  EXPECT_LE(peaks.m_per_s2, limits.max_acceleration_m_per_s2);
  EXPECT_LE(peaks.rad_per_s2, limits.max_turn_acceleration_rad_per_s2);
  EXPECT_LE(peaks.m_per_s3, limits.max_jerk_m_per_s3.value());
  EXPECT_LE(peaks.rad_per_s3, limits.max_turn_jerk_rad_per_s3.value());
}

}  // namespace mh::test
