// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>

#include "sim/motion/sensing.hpp"

namespace mh {

/// What write_readings() writes.
inline constexpr std::array<const char*, 5> kReadingFiles{"lasers.csv", "sonars.csv", "bumpers.csv",
                                                          "imu.csv", "odometry.tum"};

/// Writes what a robot's sensors read: odometry.tum, and as comma-separated text with a line of
/// headings lasers.csv, sonars.csv (m, 0 = nothing in range), bumpers.csv and imu.csv.
void write_readings(const std::filesystem::path& folder, const Robot& robot,
                    const RobotReadings& readings);

}  // namespace mh
