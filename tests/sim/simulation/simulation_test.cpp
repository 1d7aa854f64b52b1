// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "scenes/load.hpp"
#include "sim/motion/commands.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using test::add_box;
using test::empty_room;
using test::pepper;

SimulatedScene place_of(Scene scene) {
  SimulatedScene place;
  place.renderer = make_scene_renderer(scene);
  place.scene = std::make_shared<const Scene>(std::move(scene));
  return place;
}

Robot small_camera() {
  Robot robot = pepper();
  Camera& camera = robot.camera;
  camera.width_px /= 4;
  camera.height_px /= 4;
  for (double* value : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px}) *value /= 4;
  return robot;
}

Scene furnished() {
  Scene scene = empty_room();
  add_box(scene, "table", {6, 4, 0}, {7, 6, 0.8F});
  return scene;
}

/// A command that turns, drives and slides.
Twist2d command_at(int i) {
  return {0.3 * std::sin(0.1 * i), 0.1 * std::cos(0.3 * i), 0.5 * std::sin(0.05 * i)};
}

TEST(Simulation, ACommandScriptDrivesTheSameWayToTheBit) {
  const Robot robot = small_camera();
  const SimulatedScene place = place_of(furnished());
  CommandScript script;
  script.name = "test";
  script.file = "test.yaml";
  script.start_m = {3, 5};
  script.reflex = false;
  Simulation simulation(place, robot, {}, {.start_m = {3, 5}, .ticks_per_frame = 1000});
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < 60; ++i) {
    const Twist2d c = command_at(i);
    script.commands.push_back({.duration_s = 0.1,
                               .forward_m_per_s = c.x(),
                               .left_m_per_s = c.y(),
                               .turn_rad_per_s = c.z()});
    simulation.step(c, 0.1);
    places.push_back(simulation.truth().state().position_m);
  }
  const CommandedDrive drive = mh::drive(*place.scene, robot, script);
  ASSERT_EQ(drive.path.base.size(), 181U);
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_EQ(places[i], drive.path.base[3 * (i + 1)].world_from_camera.translation().head<2>());
  EXPECT_GT((places.back() - places.front()).norm(), 0.2);
}

TEST(Simulation, ItsSensorsReadWhatTheyReadAlongAFinishedPath) {
  const Robot robot = small_camera();
  const SimulatedScene place = place_of(furnished());
  Simulation simulation(place, robot, {},
                        {.start_m = {4.5, 5}, .ticks_per_frame = 1000, .seed = 7});
  std::vector<RobotObservation> seen;
  Trajectory base{{0, simulation.truth().world_from_base()}};
  for (int i = 0; i < 90; ++i) {
    seen.push_back(simulation.step({0.3, 0, 0.2}, 1.0 / 30));
    base.push_back({seen.back().stamp_ns, simulation.truth().world_from_base()});
  }
  const RobotReadings readings = read_sensors(*place.scene, robot, base, 7);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].reading.lasers_m, readings.moments[i + 1].lasers_m) << i;
    EXPECT_EQ(seen[i].reading.sonars_m, readings.moments[i + 1].sonars_m) << i;
    EXPECT_EQ(seen[i].odom_from_base.translation(),
              readings.odometry[i + 1].world_from_camera.translation());
    if (i > 0) {
      EXPECT_EQ(seen[i].reading.specific_force_m_per_s2,
                readings.moments[i].specific_force_m_per_s2);
    }
  }
}

TEST(Simulation, SameCommandsGiveTheSameBits) {
  const Robot robot = small_camera();
  const SensorConfig level = load_sensor_config(MH_SOURCE_DIR "/sim/sensors/levels/handheld.yaml");
  const SimulatedScene place = place_of(furnished());
  const auto bits = [&](std::uint64_t seed) {
    Simulation simulation(place, robot, level, {.start_m = {5, 5}, .seed = seed});
    std::uint64_t sum = 0;
    int frames = 0;
    for (int i = 0; i < 20; ++i) {
      const RobotObservation seen = simulation.step(command_at(i), 0.1);
      if (!seen.frame) continue;
      ++frames;
      EXPECT_LT(seen.frame->stamp_ns, seen.stamp_ns);
      sum = chained(sum, digest(*seen.frame));
    }
    EXPECT_EQ(frames, 20);
    return sum;
  };
  const std::uint64_t once = bits(1);
  EXPECT_EQ(once, bits(1));
  EXPECT_NE(once, bits(2));  // different noise
}

TEST(Simulation, ABumpIsToldWithItsSpeedAndPressesABumper) {
  const Robot robot = small_camera();
  Simulation simulation(place_of(furnished()), robot, {},
                        {.start_m = {4.8, 5}, .ticks_per_frame = 1000});
  bool pressed = false;
  for (int i = 0; i < 60; ++i) {
    const RobotObservation seen = simulation.step({0.3, 0, 0}, 0.1);
    pressed = pressed || std::ranges::any_of(seen.reading.bumpers, [](bool b) { return b; });
  }
  EXPECT_TRUE(pressed);
  ASSERT_FALSE(simulation.truth().bumps().empty());
  EXPECT_NEAR(simulation.truth().bumps().front().speed_m_per_s, 0.3, 0.02);
}

TEST(Simulation, CarriedInTheDarkItSeesNothingAndItsWheelsRest) {
  const Robot robot = small_camera();
  Simulation simulation(place_of(furnished()), robot, {}, {.start_m = {3, 3}});
  const SE3 before = simulation.step(Twist2d::Zero(), 0.1).odom_from_base;
  simulation.switch_light(false);
  simulation.carry_to({8, 8}, 1.0);
  const RobotObservation dark = simulation.step(Twist2d::Zero(), 0.1);
  ASSERT_TRUE(dark.frame);
  EXPECT_TRUE(std::ranges::all_of(dark.frame->depth_m, [](float d) { return d == 0; }));
  EXPECT_LT((dark.odom_from_base.translation() - before.translation()).norm(), 1e-6);
  EXPECT_NEAR(simulation.truth().state().position_m.x(), 8, 1e-6);
  simulation.switch_light(true);
  const RobotObservation lit = simulation.step(Twist2d::Zero(), 0.1);
  EXPECT_TRUE(std::ranges::any_of(lit.frame->depth_m, [](float d) { return d > 0; }));
  EXPECT_THROW(simulation.carry_to({6.5, 5}, 0), InputError);  // into the table
}

TEST(Simulation, AnotherStateOfItsSceneChangesWhatItSeesAndNothingOfItself) {
  const SimulatedScene empty = place_of(empty_room()), table = place_of(furnished());
  Simulation changed(empty, small_camera(), {}, {.start_m = {3, 5}, .ticks_per_frame = 1});
  Simulation same(empty, small_camera(), {}, {.start_m = {3, 5}, .ticks_per_frame = 1});
  for (Simulation* each : {&changed, &same})
    for (int i = 0; i < 20; ++i) each->step(Twist2d::Zero(), 0.1);
  changed.change_scene(table);
  const RobotObservation seen = changed.step(Twist2d::Zero(), 0.1),
                         as_before = same.step(Twist2d::Zero(), 0.1);
  EXPECT_EQ(seen.stamp_ns, as_before.stamp_ns);
  EXPECT_EQ(changed.time_s(), same.time_s());
  EXPECT_EQ(seen.odom_from_base.numbers(), as_before.odom_from_base.numbers());
  EXPECT_NE(digest(*seen.frame), digest(*as_before.frame));
  EXPECT_NE(seen.reading.lasers_m, as_before.reading.lasers_m);
  changed.change_scene(empty);
  EXPECT_EQ(digest(*changed.step(Twist2d::Zero(), 0.1).frame),
            digest(*same.step(Twist2d::Zero(), 0.1).frame));
  changed.carry_to({6.5, 5}, 0);
  EXPECT_THROW(changed.change_scene(table), InputError);  // the table would be in the robot
  EXPECT_EQ(changed.truth().state().position_m, Eigen::Vector2d(6.5, 5));
}

TEST(Simulation, ATwoWheeledRobotIsNotMovedSidewaysAndKnowsItsWay) {
  Simulation simulation(place_of(furnished()), test::turtlebot(), {},
                        {.start_m = {3, 5}, .ticks_per_frame = 1000});
  RobotObservation seen;
  for (int i = 0; i < 20; ++i) seen = simulation.step({0.1, 0.2, 0}, 0.1);
  const Eigen::Vector3d at = simulation.truth().world_from_base().translation();
  EXPECT_NEAR(at.x(), 3.2, 0.01);
  EXPECT_NEAR(at.y(), 5.0, 1e-6);
  // 1 % too long, within the wheel spread and slip that the robot's file allows.
  EXPECT_NEAR(seen.odom_from_base.translation().x() - 3, 1.01 * (at.x() - 3), 0.01);
  EXPECT_EQ(seen.reading.lasers_m[0].size(), 360U);
  EXPECT_GT(seen.reading.specific_force_m_per_s2.z(), 9);
}

TEST(Simulation, ARobotWithoutWheelsIsRefused) {
  Robot robot = small_camera();
  robot.equipment = nullptr;
  EXPECT_THROW(Simulation(place_of(empty_room()), robot, {}, {.start_m = {5, 5}}), InputError);
}

}  // namespace
}  // namespace mh
