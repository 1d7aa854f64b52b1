// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/planar_world.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using test::add_box;
using test::empty_room;
using test::pepper;

const BaseCommand kEast{.velocity_m_per_s = {0.5, 0.0}, .turn_rad_per_s = 0.0};

TEST(PlanarWorld, FreeMotionFollowsTheLawOfConstantAcceleration) {
  const Robot robot = pepper();
  PlanarWorld world(empty_room(), robot, {2, 5}, 0.3);
  // Reaching 0.5 m/s takes v / a; after that, the distance is v t - v^2 / 2a.
  const double time_s = 5.0, v = 0.5, a = robot.limits.max_acceleration_m_per_s2;
  for (int i = 0; i < std::lround(time_s / world.step_s()); ++i) world.step(kEast);
  const BaseState state = world.state();
  EXPECT_NEAR(state.position_m.x(), 2 + v * time_s - v * v / (2 * a), 2e-3);  // one step: 2 mm
  EXPECT_NEAR(state.position_m.y(), 5, 1e-6);
  EXPECT_NEAR(state.heading_rad, 0.3, 1e-6);
}

TEST(PlanarWorld, VelocityAndAccelerationStayWithinLimits) {
  const Robot robot = pepper();
  const BaseLimits& limits = robot.limits;
  PlanarWorld world(empty_room(), robot, {5, 5}, 0);
  BaseState before = world.state();
  double top_speed = 0, top_turn = 0;
  for (int i = 0; i < 2400; ++i) {
    // The commands are far too fast, and their direction jumps every 1.2 s.
    const double angle = 2.4 * (i / 288);
    world.step({.velocity_m_per_s = {3 * std::cos(angle), 3 * std::sin(angle)},
                .turn_rad_per_s = (i / 400) % 2 == 0 ? 9.0 : -9.0});
    const BaseState now = world.state();
    const double dv = (now.velocity_m_per_s - before.velocity_m_per_s).norm();
    ASSERT_LE(now.velocity_m_per_s.norm(), limits.max_velocity_m_per_s * 1.00001);
    ASSERT_LE(std::abs(now.turn_rad_per_s), limits.max_turn_rad_per_s * 1.00001);
    // Single precision: velocities have errors of about 1e-6, divided by a step of 1/240 s.
    ASSERT_LE(dv / world.step_s(), limits.max_acceleration_m_per_s2 + 5e-4);
    ASSERT_LE(std::abs(now.turn_rad_per_s - before.turn_rad_per_s) / world.step_s(),
              limits.max_turn_acceleration_rad_per_s2 + 5e-4);
    top_speed = std::max(top_speed, now.velocity_m_per_s.norm());
    top_turn = std::max(top_turn, std::abs(now.turn_rad_per_s));
    before = now;
  }
  EXPECT_NEAR(top_speed, limits.max_velocity_m_per_s, 1e-3);  // the limits were put to the test
  EXPECT_NEAR(top_turn, limits.max_turn_rad_per_s, 1e-3);
}

TEST(PlanarWorld, AWallStopsTheRobot) {
  PlanarWorld world(empty_room(), pepper(), {9, 5}, 0);
  double deepest = 0;
  Contact contact;
  for (int i = 0; i < 1200; ++i) {
    contact = world.step(kEast);
    deepest = std::max(deepest, contact.penetration_m);
  }
  EXPECT_TRUE(contact.touching);
  EXPECT_EQ(contact.instance, 5);  // east wall
  EXPECT_LE(deepest, 5e-3);
  EXPECT_NEAR(world.state().position_m.x(), 10 - 0.26, 5e-3);
}

TEST(PlanarWorld, ATableTopStopsTheRobotThoughItHangsInTheAir) {
  Scene scene = empty_room();
  add_box(scene, "table top", {5, 4, 0.72F}, {6, 6, 0.75F});
  add_box(scene, "board just below the head", {5, 7, 1.19F}, {6, 9, 1.3F});
  for (const double y : {5.0, 8.0}) {
    PlanarWorld world(scene, pepper(), {4, y}, 0);
    double deepest = 0;
    for (int i = 0; i < 1200; ++i) deepest = std::max(deepest, world.step(kEast).penetration_m);
    EXPECT_NEAR(world.state().position_m.x(), 5 - 0.26, 5e-3);
    EXPECT_LE(deepest, 5e-3);
  }
}

TEST(PlanarWorld, RugsAndLintelsAreNoObstacles) {
  Scene scene = empty_room();
  add_box(scene, "rug", {4, 4, 0}, {6, 6, 0.02F});
  add_box(scene, "lintel", {6.5F, 0, 2.0F}, {6.6F, 10, 2.5F});
  PlanarWorld world(scene, pepper(), {3, 5}, 0);
  for (int i = 0; i < 2400; ++i) ASSERT_FALSE(world.step(kEast).touching);
  EXPECT_GT(world.state().position_m.x(), 7.0);
}

TEST(PlanarWorld, RunsAreBitEqual) {
  const auto run = [] {
    Scene scene = empty_room();
    add_box(scene, "box", {5, 4.9F, 0}, {6, 6, 1});
    PlanarWorld world(scene, pepper(), {4, 5}, 0);
    std::vector<double> states;
    for (int i = 0; i < 2400; ++i) {
      world.step({.velocity_m_per_s = {0.5, -0.05 * std::sin(0.01 * i)}, .turn_rad_per_s = 0.4});
      const BaseState s = world.state();
      states.insert(states.end(), {s.position_m.x(), s.position_m.y(), s.heading_rad,
                                   s.velocity_m_per_s.x(), s.velocity_m_per_s.y()});
    }
    return states;
  };
  EXPECT_EQ(run(), run());
}

TEST(PlanarWorld, SeesAStartInsideFurniture) {
  Scene scene = empty_room();
  add_box(scene, "sofa", {4, 4, 0}, {5, 6, 0.8F});
  const Contact contact = PlanarWorld(scene, pepper(), {3.84, 5}, 0).contact();
  EXPECT_NEAR(contact.penetration_m, 0.1, 1e-3);
  EXPECT_EQ(contact.instance, 6);
  EXPECT_FALSE(PlanarWorld(scene, pepper(), {3, 5}, 0).contact().touching);
  add_box(scene, "bed", {6, 4, 0.2F}, {8, 6, 0.6F});
  const Contact in_bed = PlanarWorld(scene, pepper(), {7, 5.1}, 0).contact();  // it touches no face
  EXPECT_NEAR(in_bed.penetration_m, 0.26, 1e-6);
  EXPECT_EQ(in_bed.instance, 7);
}

}  // namespace
}  // namespace mh
