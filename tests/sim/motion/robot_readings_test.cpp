// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/robot_readings.hpp"

#include <unistd.h>

#include <gtest/gtest.h>

#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

// All numbers are different, so that no two of them can be swapped without a failure.
TEST(WriteReadings, EachNumberStandsUnderItsHeading) {
  auto equipment = std::make_shared<Equipment>();
  equipment->lasers = {{.name = "left", .base_from_laser = {}, .rays = 2},
                       {.name = "right", .base_from_laser = {}, .rays = 3}};
  equipment->sonars = {{.name = "front", .base_from_sonar = {}},
                       {.name = "back", .base_from_sonar = {}}};
  equipment->bumpers = {"bow", "stern"};
  equipment->wheels.emplace();
  equipment->base_from_imu.emplace();
  Robot robot;
  robot.equipment = equipment;
  RobotReadings readings;
  readings.odometry = {{1'500'000'000, SE3(Eigen::Matrix3d::Identity(), {1, 2, 3})}};
  readings.moments = {{.stamp_ns = 1'500'000'000,
                       .lasers_m = {{0.1F, 0.2F}, {0.3F, 0.4F, 0.5F}},
                       .sonars_m = {0.6F, 0.7F},
                       .bumpers = {true, false},
                       .specific_force_m_per_s2 = {8, 9, 10},
                       .turn_rad_per_s = {0.25, -0.5, 0.75}},
                      {.stamp_ns = 1'600'000'000,
                       .lasers_m = {{0, 1}, {2, 3, 4}},
                       .sonars_m = {0, 1.25F},
                       .bumpers = {false, true}}};
  const fs::path folder = fs::temp_directory_path() / ("mh_readings_" + std::to_string(getpid()));
  fs::create_directories(folder);
  write_readings(folder, robot, readings);
  EXPECT_EQ(read_file(folder / "lasers.csv"),
            "stamp_s,laser,range_0_m,range_1_m,range_2_m\n"
            "1.500000000,left,0.1000,0.2000\n"
            "1.500000000,right,0.3000,0.4000,0.5000\n"
            "1.600000000,left,0.0000,1.0000\n"
            "1.600000000,right,2.0000,3.0000,4.0000\n");
  EXPECT_EQ(read_file(folder / "sonars.csv"),
            "stamp_s,front_m,back_m\n1.500000000,0.600,0.700\n1.600000000,0.000,1.250\n");
  EXPECT_EQ(read_file(folder / "bumpers.csv"),
            "stamp_s,bow,stern\n1.500000000,1,0\n1.600000000,0,1\n");
  EXPECT_EQ(read_file(folder / "imu.csv"),
            "stamp_s,force_x_m_per_s2,force_y_m_per_s2,force_z_m_per_s2,turn_x_rad_per_s,"
            "turn_y_rad_per_s,turn_z_rad_per_s\n"
            "1.500000000,8,9,10,0.25,-0.5,0.75\n"
            "1.600000000,0,0,0,0,0,0\n");
  const std::string odometry = read_file(folder / "odometry.tum");
  EXPECT_TRUE(odometry.ends_with("\n1.500000000 1 2 3 0 0 0 1\n")) << odometry;
  fs::remove_all(folder);
  fs::create_directories(folder);
  equipment->wheels.reset();
  equipment->base_from_imu.reset();
  write_readings(folder, robot, readings);
  EXPECT_TRUE(fs::exists(folder / "lasers.csv"));
  EXPECT_FALSE(fs::exists(folder / "odometry.tum"));
  EXPECT_FALSE(fs::exists(folder / "imu.csv"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace mh
