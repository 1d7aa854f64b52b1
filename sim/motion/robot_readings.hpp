// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>

#include "sim/motion/sensing.hpp"

namespace mh {

/// Files that write_readings() writes.
inline constexpr std::array<const char*, 5> kReadingFiles{"lasers.csv", "sonars.csv", "bumpers.csv",
                                                          "imu.csv", "odometry.tum"};

/// Writes a robot's sensor readings: odometry.tum (if it has wheels) and, as CSV with a header
/// line, lasers.csv, sonars.csv (m, 0 = nothing in range), bumpers.csv and imu.csv (if it has an
/// IMU).
void write_readings(const std::filesystem::path& folder, const Robot& robot,
                    const RobotReadings& readings);

}  // namespace mh
