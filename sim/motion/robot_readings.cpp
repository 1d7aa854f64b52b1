// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/robot_readings.hpp"

#include <string>

#include <fmt/format.h>

#include "slam/core/trajectory_io.hpp"
#include "slam/io/files.hpp"

namespace mh {

void write_readings(const std::filesystem::path& folder, const Robot& robot,
                    const RobotReadings& readings) {
  const Equipment& e = *robot.equipment;
  std::string lasers = "stamp_s,laser", sonars = "stamp_s", bumpers = "stamp_s";
  std::size_t rays = 0;
  for (const LaserScanner& laser : e.lasers)
    rays = std::max(rays, static_cast<std::size_t>(laser.rays));
  for (std::size_t k = 0; k < rays; ++k) lasers += fmt::format(",range_{}_m", k);
  for (const Sonar& sonar : e.sonars) sonars += fmt::format(",{}_m", sonar.name);
  for (const std::string& bumper : e.bumpers) bumpers += "," + bumper;
  lasers += "\n", sonars += "\n", bumpers += "\n";
  std::string imu =
      "stamp_s,force_x_m_per_s2,force_y_m_per_s2,force_z_m_per_s2,turn_x_rad_per_s,"
      "turn_y_rad_per_s,turn_z_rad_per_s\n";
  for (const RobotReading& r : readings.moments) {
    const std::string stamp = format_stamp(r.stamp_ns);
    for (std::size_t l = 0; l < r.lasers_m.size(); ++l) {
      lasers += stamp + "," + e.lasers[l].name;
      for (const float range : r.lasers_m[l]) lasers += fmt::format(",{:.4f}", range);
      lasers += "\n";
    }
    sonars += stamp;
    for (const float range : r.sonars_m) sonars += fmt::format(",{:.3f}", range);
    bumpers += stamp;
    for (const bool pressed : r.bumpers) bumpers += pressed ? ",1" : ",0";
    imu += stamp;
    for (int k = 0; k < 3; ++k) imu += fmt::format(",{:.9g}", r.specific_force_m_per_s2[k]);
    for (int k = 0; k < 3; ++k) imu += fmt::format(",{:.9g}", r.turn_rad_per_s[k]);
    sonars += "\n", bumpers += "\n", imu += "\n";
  }
  write_atomically(folder / "lasers.csv", lasers);
  write_atomically(folder / "sonars.csv", sonars);
  write_atomically(folder / "bumpers.csv", bumpers);
  if (e.base_from_imu) write_atomically(folder / "imu.csv", imu);
  if (e.wheels) write_tum(folder / "odometry.tum", readings.odometry);
}

}  // namespace mh
