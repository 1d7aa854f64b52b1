// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "sim/motion/sensing.hpp"

namespace mh {

/// Writes what a robot's sensors read: odometry.tum, and as comma-separated text with a line of
/// headings lasers.csv, sonars.csv (m, 0 = nothing in range), bumpers.csv and imu.csv.
void write_readings(const std::filesystem::path& folder, const Robot& robot,
                    const RobotReadings& readings);

}  // namespace mh
