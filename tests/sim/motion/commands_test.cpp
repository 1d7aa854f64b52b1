// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/commands.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sim/motion/commanded_base.hpp"
#include "sim/motion/sensing.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "tests/sim/boxes.hpp"
#include "tests/sim/motion/limits_kept.hpp"

namespace mh {
namespace {

using test::add_box;
using test::empty_room;
using test::pepper;

CommandScript script_of(std::vector<VelocityCommand> commands, bool reflex = false) {
  CommandScript script;
  script.name = "test";
  script.file = "test.yaml";
  script.start_m = {5, 5};
  script.reflex = reflex;
  script.commands = std::move(commands);
  return script;
}

TEST(Commands, ReadsAScriptAndNamesWhatIsWrong) {
  const std::string file = testing::TempDir() + "commands_test.yaml";
  const std::string head = "name: t\nstart: {position: [1, 2], heading_deg: 90}\n";
  const auto refusal = [&](const std::string& text) -> std::string {
    write_atomically(file, text);
    try {
      load_commands(file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  write_atomically(file, head +
                             "reflex: false\ncommands:\n"
                             "- {for_s: 2, forward_m_per_s: 0.3, turn_deg_per_s: -90}\n"
                             "- {for_s: 1.5, left_m_per_s: 0.1, head_yaw_deg: 45}\n");
  const CommandScript script = load_commands(file);
  EXPECT_EQ(script.reflex, false);
  ASSERT_EQ(script.commands.size(), 2U);
  EXPECT_DOUBLE_EQ(script.commands[0].turn_rad_per_s, -M_PI_2);
  EXPECT_DOUBLE_EQ(script.commands[1].head_yaw_rad.value(), M_PI_4);
  EXPECT_FALSE(script.commands[1].head_pitch_rad);
  EXPECT_EQ(script.commands[1].line, 6);
  EXPECT_NE(refusal(head + "commands: []\n").find("at least one"), std::string::npos);
  EXPECT_NE(refusal(head + "commands:\n- {for_s: -1}\n").find(":4: commands[0].for_s: -1"),
            std::string::npos);
  EXPECT_NE(refusal(head + "commands:\n- {for_s: 1, sideways: 2}\n").find("sideways"),
            std::string::npos);
}

TEST(Commands, RandomCommandsKeepEveryLimitOfTheRobot) {
  const Robot robot = pepper();
  const RandomStream draw(11);
  std::vector<VelocityCommand> commands;
  for (std::uint64_t i = 0; i < 150; ++i)
    commands.push_back({.duration_s = draw.uniform(5 * i, 0.05, 1.5),
                        .forward_m_per_s = draw.uniform(5 * i + 1, -0.8, 0.8),
                        .left_m_per_s = draw.uniform(5 * i + 2, -0.8, 0.8),
                        .turn_rad_per_s = draw.uniform(5 * i + 3, -1.5, 1.5)});
  Scene wide;  // nothing to run into
  wide.name = "wide";
  wide.materials.emplace_back();
  add_box(wide, "floor", {-100, -100, -0.1F}, {100, 100, 0});
  const CommandedDrive result = drive(wide, robot, script_of(commands));
  EXPECT_EQ(result.path.contact_time_s, 0.0);
  test::expect_limits_kept(result.path.peaks, robot.limits);
  EXPECT_LE(result.path.peaks.rim_m_per_s, robot.wheels()->max_rim_m_per_s);
  EXPECT_GT(result.path.peaks.rim_m_per_s, 0.7 * robot.wheels()->max_rim_m_per_s);
  EXPECT_GT(result.path.length_m, 10);

  const CommandedDrive again = drive(wide, robot, script_of(commands));
  ASSERT_EQ(result.path.base.size(), again.path.base.size());
  for (std::size_t i = 0; i < result.path.base.size(); ++i)
    ASSERT_EQ(result.path.base[i].world_from_camera.translation(),
              again.path.base[i].world_from_camera.translation());
}

TEST(Commands, TheReflexStopsTheRobotFortyCentimetersBeforeAWall) {
  const VelocityCommand east{.duration_s = 20, .forward_m_per_s = 0.5};
  const CommandedDrive careful = drive(empty_room(), pepper(), script_of({east}, true));
  const CommandedDrive bold = drive(empty_room(), pepper(), script_of({east}, false));
  const double careful_x = careful.path.base.back().world_from_camera.translation().x();
  EXPECT_NEAR(careful_x, 10 - 0.26 - 0.40, 2e-3);
  EXPECT_EQ(careful.path.contact_time_s, 0.0);
  EXPECT_GT(careful.reflex_time_s, 1.0);
  EXPECT_NEAR(bold.path.base.back().world_from_camera.translation().x(), 10 - 0.26, 5e-3);
  EXPECT_GT(bold.path.contact_time_s, 1.0);
  EXPECT_LE(bold.path.max_penetration_m, 5e-3);
}

TEST(Commands, TheReflexKeepsItsDistanceAtAnySpeedAndSlant) {
  const Robot robot = pepper();
  const double ahead_m = robot.equipment->reflex->ahead_m;
  for (const double speed : {0.1, 0.3, 0.55})
    for (const double heading_deg : {0.0, 10.0, 33.0}) {
      CommandScript script = script_of({{.duration_s = 60, .forward_m_per_s = speed}}, true);
      script.start_heading_rad = heading_deg * M_PI / 180;
      const double x =
          drive(empty_room(), robot, script).path.base.back().world_from_camera.translation().x();
      // The distance left along the path is the smaller of two: to where the shell's foremost point
      // would touch the wall, and to where a part of the wall that is less than aside_m to the side
      // of the shell would be level with the center.
      const double slant = std::tan(script.start_heading_rad), half_m = 0.26 + 0.10;
      const double touch_m = (10 - x - 0.26) / std::cos(script.start_heading_rad);
      const double level_m = (10 - x) / std::cos(script.start_heading_rad) - half_m * slant;
      EXPECT_NEAR(std::min(touch_m, level_m), ahead_m, 2e-3) << speed << " " << heading_deg;
      EXPECT_GE(std::min(touch_m, level_m), ahead_m - 1e-4) << speed << " " << heading_deg;
    }
}

TEST(Commands, TheReflexLooksTenCentimetersAside) {
  for (const auto& [gap_m, stops] : {std::pair(0.095F, true), std::pair(0.105F, false)})
    for (const float side : {-1.0F, 1.0F}) {
      Scene scene = empty_room();
      const float near = 5 + side * (0.26F + gap_m), far = 5 + side * 0.8F;
      add_box(scene, "post", {6.5F, std::min(near, far), 0}, {6.6F, std::max(near, far), 1});
      const double x =
          drive(scene, pepper(), script_of({{.duration_s = 8, .forward_m_per_s = 0.4}}, true))
              .path.base.back()
              .world_from_camera.translation()
              .x();
      if (stops)
        EXPECT_NEAR(x, 6.5 - 0.40, 2e-3) << side;
      else
        EXPECT_GT(x, 7.5) << side;
    }
}

TEST(Commands, TheReflexLetsPassWhatIsAsideAndStopsForAPerson) {
  Scene scene = empty_room();
  add_box(scene, "shelf", {6, 5.40F, 0}, {8, 6, 1});         // 0.14 m beside the path
  add_box(scene, "bin", {6, 4.2F, 0}, {6.5F, 4.68F, 0.5F});  // 0.06 m beside the path
  CommandScript script = script_of({{.duration_s = 8, .forward_m_per_s = 0.4}}, true);
  const auto end_x = [&](const std::vector<MovingObstacle>& others) {
    return drive(scene, pepper(), script, others)
        .path.base.back()
        .world_from_camera.translation()
        .x();
  };
  EXPECT_LT(end_x({}), 5.8);  // the bin is too close
  scene = empty_room();
  add_box(scene, "shelf", {6, 5.40F, 0}, {8, 6, 1});
  EXPECT_GT(end_x({}), 7.5);
  const MovingObstacle person{.instance = 99,
                              .path = [](double) { return Eigen::Vector2d(7, 4.9); }};
  const double before_person = end_x({person});
  EXPECT_LT(before_person, 7 - 0.26 - 0.22 - 0.35);
  EXPECT_GT(before_person, 7 - 0.26 - 0.22 - 0.50);
}

TEST(Commands, HeadJointsMoveTheCameraAndKeepTheirLimits) {
  const Robot robot = pepper();
  const CommandedDrive result =
      drive(empty_room(), robot,
            script_of({{.duration_s = 1.0},
                       {.duration_s = 1.0, .head_yaw_rad = M_PI_2, .head_pitch_rad = 0.3}}));
  ASSERT_EQ(result.path.head.size(), result.path.camera.size());
  EXPECT_TRUE(result.path.camera.front().world_from_camera.translation().isApprox(
      Eigen::Vector3d(5, 5, 0) + robot.base_from_camera.translation(), 1e-9));
  const Eigen::Vector3d ahead = result.path.camera.back().world_from_camera.rotation().col(2);
  EXPECT_NEAR(std::atan2(ahead.y(), ahead.x()), M_PI_2, 1e-6);
  EXPECT_NEAR(std::asin(-ahead.z()), 0.3, 1e-6);
  double fastest = 0;
  for (std::size_t i = 1; i < result.path.head.size(); ++i)
    fastest = std::max(fastest, (result.path.head[i][0] - result.path.head[i - 1][0]) * 30);
  EXPECT_LE(fastest, 7.33998 + 1e-6);
  EXPECT_GT(fastest, 7.0);
  try {
    drive(empty_room(), robot, script_of({{.duration_s = 1, .head_pitch_rad = 1.0, .line = 4}}));
    FAIL() << "the head went too far";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("test.yaml:4: HeadPitch: 57.3 deg is outside"),
              std::string::npos)
        << e.what();
  }
}

TEST(Commands, AStartInsideFurnitureIsRefused) {
  Scene scene = empty_room();
  add_box(scene, "sofa", {5.1F, 4, 0}, {6, 6, 0.8F});
  EXPECT_THROW(drive(scene, pepper(), script_of({{.duration_s = 1}})), InputError);
}

TEST(Commands, AStartInsideAPersonIsRefused) {
  const MovingObstacle person{.instance = 99,
                              .path = [](double) { return Eigen::Vector2d(5.1, 5); }};
  try {
    drive(empty_room(), pepper(), script_of({{.duration_s = 1}}), {person});
    FAIL() << "the robot started in a person";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("mm inside a pedestrian"), std::string::npos) << e.what();
  }
}

TEST(CommandedBase, WhoIsShovedDidNotDriveThere) {
  // A person walks into the robot and stops; the robot rolls on until the wall behind it, at x = 0.
  const MovingObstacle person{.instance = 99, .path = [](double time_s) {
                                return Eigen::Vector2d(std::max(3.0 - 0.8 * time_s, 1.1), 5);
                              }};
  CommandedBase base(empty_room(), pepper(), {2, 5}, 0, false);
  base.add(person);
  double fastest = 0;
  while (base.time_s() < 5) {
    base.step(Twist2d::Zero());
    fastest = std::max(fastest, base.state().velocity_m_per_s.norm());
  }
  EXPECT_GT(fastest, 0.6);
  EXPECT_LT(base.state().position_m.x(), 0.3);
  ASSERT_GE(base.bumps().size(), 2U);
  for (const Bump& bump : base.bumps()) EXPECT_LT(bump.speed_m_per_s, 1e-3) << bump.instance;
}

TEST(CommandedBase, WhoDrivesIntoAPersonDid) {
  const MovingObstacle person{.instance = 99, .path = [](double) { return Eigen::Vector2d(4, 5); }};
  CommandedBase base(empty_room(), pepper(), {2, 5}, 0, false);
  base.add(person);
  while (base.time_s() < 6 && base.bumps().empty()) base.step({0.3, 0, 0});
  ASSERT_FALSE(base.bumps().empty());
  EXPECT_NEAR(base.bumps()[0].speed_m_per_s, 0.3, 0.02);
}

TEST(ReadSensors, LasersAndSonarsMeasureTheRoom) {
  Scene scene = empty_room();
  add_box(scene, "box", {6.5F, 4, 0}, {7, 6, 1});
  const Trajectory base = {{0, SE3(Eigen::Matrix3d::Identity(), {5, 5, 0})}};
  const RobotReadings readings = read_sensors(scene, pepper(), base, 0);
  const RobotReading& r = readings.moments.at(0);
  ASSERT_EQ(r.lasers_m.size(), 3U);
  ASSERT_EQ(r.lasers_m[0].size(), 15U);
  EXPECT_NEAR(r.lasers_m[0][7], 1.5 - 0.0562, 1e-4);  // the middle ray of the front laser
  // Outer rays at 30 deg: the box is 2 m wide, its face is 1.44 m away.
  EXPECT_NEAR(r.lasers_m[0][0], (1.5 - 0.0562) / std::cos(M_PI / 6), 1e-3);
  EXPECT_EQ(r.lasers_m[1][7], 0.0F);  // nothing within 3 m to the left
  EXPECT_NEAR(r.sonars_m[0], 1.5 - 0.0699, 0.03);
  EXPECT_EQ(r.sonars_m[1], 0.0F);
  EXPECT_NEAR(r.specific_force_m_per_s2.z(), 9.81, 1e-9);
  EXPECT_FALSE(r.bumpers[0] || r.bumpers[1] || r.bumpers[2]);

  // A person stands behind the robot.
  const MovingObstacle person{.path = [](double) { return Eigen::Vector2d(3.5, 5); }};
  const RobotReadings with = read_sensors(scene, pepper(), base, 0, {person});
  EXPECT_NEAR(with.moments.at(0).sonars_m[1], 1.5 - 0.0718 - 0.22, 0.04);
}

TEST(ReadSensors, LaserNoiseIsTheLargerOfALengthAndAShare) {
  Robot robot = pepper();
  auto equipment = std::make_shared<Equipment>(*robot.equipment);
  LaserScanner& laser = equipment->lasers[0];
  laser.rays = 2001;
  laser.field_of_view_rad = 1e-6;  // all rays measure the same distance
  laser.sigma_m = 0.010;
  laser.sigma_share = 0.035;
  robot.equipment = equipment;
  for (const double ahead_m : {0.25, 2.0}) {
    Scene scene = empty_room();
    const float x = static_cast<float>(5.0562 + ahead_m);
    add_box(scene, "box", {x, 4, 0}, {x + 0.5F, 6, 1});
    const Trajectory base = {{0, SE3(Eigen::Matrix3d::Identity(), {5, 5, 0})}};
    const auto ranges_m = [&](std::uint64_t seed) {
      return read_sensors(scene, robot, base, seed).moments[0].lasers_m[0];
    };
    double sum = 0, squares = 0;
    for (const float range_m : ranges_m(1)) {
      sum += range_m - ahead_m;
      squares += (range_m - ahead_m) * (range_m - ahead_m);
    }
    const double sigma_m = std::max(0.010, 0.035 * ahead_m);
    EXPECT_NEAR(sum / 2001, 0, 4 * sigma_m / std::sqrt(2001.0)) << ahead_m;
    EXPECT_NEAR(std::sqrt(squares / 2001), sigma_m, 0.07 * sigma_m) << ahead_m;
    EXPECT_EQ(ranges_m(1), ranges_m(1));
    EXPECT_NE(ranges_m(1), ranges_m(2));
  }
}

TEST(ReadSensors, TheBumperThatIsTouchedIsPressed) {
  const VelocityCommand west{.duration_s = 15, .forward_m_per_s = -0.5};
  const CommandedDrive back = drive(empty_room(), pepper(), script_of({west}));
  const RobotReadings readings = read_sensors(empty_room(), pepper(), back.path.base, 0);
  const RobotReading& last = readings.moments.back();
  EXPECT_FALSE(last.bumpers[0] || last.bumpers[1]);
  EXPECT_TRUE(last.bumpers[2]);
  EXPECT_FALSE(readings.moments.front().bumpers[2]);
}

TEST(ReadSensors, TheImuFeelsAccelerationAndTurning) {
  Trajectory base;  // constant acceleration of 0.3 m/s2 ahead, then none; turning at 0.5 rad/s
  for (int i = 0; i <= 60; ++i) {
    const double t = i / 30.0;
    base.push_back(
        {std::llround(t * 1e9), SE3(Eigen::Matrix3d::Identity(), {1 + 0.15 * t * t, 5, 0})});
  }
  const RobotReadings straight = read_sensors(empty_room(), pepper(), base, 0);
  EXPECT_NEAR(straight.moments[30].specific_force_m_per_s2.x(), 0.3, 1e-6);
  for (std::size_t i = 0; i < base.size(); ++i)
    base[i].world_from_camera =
        SE3(Eigen::AngleAxisd(0.5 * static_cast<double>(i) / 30, Eigen::Vector3d::UnitZ())
                .toRotationMatrix(),
            {5, 5, 0});
  const RobotReadings turning = read_sensors(empty_room(), pepper(), base, 0);
  EXPECT_NEAR(turning.moments[30].turn_rad_per_s.z(), 0.5, 1e-6);
}

}  // namespace
}  // namespace mh
