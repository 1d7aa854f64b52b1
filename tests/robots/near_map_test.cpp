// SPDX-License-Identifier: Apache-2.0
#include "robots/navigation/near_map.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "robots/navigation/belief.hpp"
#include "robots/navigation/follow.hpp"
#include "robots/navigation/lost.hpp"
#include "robots/navigation/smooth.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

/// One laser that looks ahead, with a range of 3 m.
Equipment one_laser() {
  Equipment equipment;
  equipment.lasers = {
      {.name = "front", .base_from_laser = {}, .rays = 31, .field_of_view_rad = 1.0}};
  return equipment;
}

TEST(NearMap, AWallAheadIsThereAndTheFloorBeforeItIsFree) {
  NearMap map;
  const std::vector<std::vector<float>> wall{std::vector<float>(31, 2.0F)};
  map.add_lasers(one_laser(), wall, {});
  EXPECT_FALSE(map.obstacles_near({2, 0}, 0.1).empty());
  EXPECT_TRUE(map.obstacles_near({1, 0}, 0.5).empty());
  const FloorGrid grid = map.grid();
  EXPECT_GT(grid.clearance_at({1.0, 0}), 0.2);
  EXPECT_EQ(grid.clearance_at({2.5, 0}), 0);   // behind the wall
  EXPECT_EQ(grid.clearance_at({-1.0, 0}), 0);  // behind the robot: never seen
}

TEST(NearMap, WhatALaserSeesThroughIsGone) {
  NearMap map;
  std::vector<std::vector<float>> scan{std::vector<float>(31, 1.0F)};
  map.add_lasers(one_laser(), scan, {});
  ASSERT_FALSE(map.obstacles_near({1, 0}, 0.1).empty());
  scan[0].assign(31, 0.0F);  // nothing in range
  map.add_lasers(one_laser(), scan, {});
  EXPECT_TRUE(map.obstacles_near({1, 0}, 0.3).empty());
}

TEST(NearMap, ATableTopStaysThoughLasersPassBelowIt) {
  const Robot robot = test::pepper();
  NearMap map;
  // A camera that looks ahead sees a top edge 2 m away and 0.4 m below the camera.
  Grid2d<float> depth(robot.camera.width_px, robot.camera.height_px, 3.4F);
  const int row = static_cast<int>(robot.camera.cy_px + robot.camera.fy_px * 0.4 / 2.0);
  for (int y = row - 8; y <= row + 8; ++y)
    for (int x = 0; x < depth.width(); ++x) depth(x, y) = 2.0F;
  map.add_depth(depth, robot.camera, robot.base_from_camera, {});
  ASSERT_FALSE(map.obstacles_near({2.0, 0}, 0.15).empty());
  const std::vector<std::vector<float>> through{std::vector<float>(31, 0.0F)};
  map.add_lasers(one_laser(), through, {});
  EXPECT_FALSE(map.obstacles_near({2.0, 0}, 0.15).empty());
}

TEST(NearMap, ItMovesWithTheRobotAndForgetsWhenItIsCarried) {
  NearMap map;
  map.add_contact({3, 1});
  map.add_lasers(one_laser(), {}, {{4, 0}, 0});
  ASSERT_EQ(map.obstacles_near({3, 1}, 0.1).size(), 1U);
  EXPECT_LT((map.obstacles_near({3, 1}, 0.1).front() - Vector2d(3, 1)).norm(), 0.03);
  map.clear();
  EXPECT_TRUE(map.obstacles_near({3, 1}, 0.5).empty());
}

TEST(Follow, BrakesInTimeAndPassesBy) {
  const std::vector<Vector2d> ahead{{1.0, 0}}, aside{{1.0, 0.5}}, beside{{0.05, 0.25}};
  const Vector2d x(1, 0);
  EXPECT_NEAR(speed_before(ahead, {0, 0}, x, 0.3, 0.2), std::sqrt(2 * 0.2 * 0.7), 1e-9);
  EXPECT_TRUE(std::isinf(speed_before(aside, {0, 0}, x, 0.3, 0.2)));
  EXPECT_TRUE(std::isinf(speed_before(beside, {0, 0}, x, 0.3, 0.2)));    // it may pass by
  EXPECT_EQ(speed_before(beside, {0, 0}, Vector2d(0, 1), 0.3, 0.2), 0);  // but not drive there
}

TEST(Follow, SteersAlongThePathAndSaysWhenItIsThere) {
  const Robot robot = test::pepper();
  std::vector<Vector2d> path;
  for (int i = 0; i <= 40; ++i) path.emplace_back(0.05 * i, 0);
  const Steering along = follow(path, {{0, 0.05}, 0}, {}, robot);
  EXPECT_GT(along.command.x(), 0.2);
  EXPECT_LT(along.command.y(), 0);  // back to the path
  EXPECT_NEAR(along.left_m, 2.05, 0.01);
  const Steering turned = follow(path, {{0, 0}, 2.0}, {}, robot);
  EXPECT_EQ(turned.command.head<2>().norm(), 0);  // it first turns to face the path
  EXPECT_LT(turned.command.z(), 0);
  EXPECT_TRUE(follow(path, {{1.97, 0}, 0}, {}, robot).arrived);
  const std::vector<Vector2d> box{{0.5, 0.1}};
  EXPECT_TRUE(follow(path, {{0.22, 0}, 0}, box, robot).blocked);
}

TEST(Smooth, RoundsACornerAndKeepsItsEnds) {
  FloorGrid grid;
  grid.resolution_m = 0.05;
  grid.clearance_m = Grid2d<float>(100, 100, 1.0F);
  grid.occupant = Grid2d<std::uint16_t>(100, 100);
  const std::vector<Vector2d> corner{{1, 1}, {3, 1}, {3, 3}};
  const std::vector<Vector2d> path = smoothed(grid, corner, 0.3);
  EXPECT_EQ(path.front(), corner.front());
  EXPECT_EQ(path.back(), corner.back());
  EXPECT_LT(length_m(path), length_m(corner));
  double sharpest = 1;
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
    sharpest = std::min(
        sharpest, (path[i] - path[i - 1]).normalized().dot((path[i + 1] - path[i]).normalized()));
  EXPECT_GT(sharpest, 0.9);
}

TEST(LookAround, GoesWhereItHasNotBeen) {
  FloorGrid grid;
  grid.resolution_m = 0.05;
  Grid2d<std::uint8_t> blocked(120, 40, 1);
  for (int y = 2; y < 38; ++y)
    for (int x = 2; x < 118; ++x) blocked(x, y) = 0;
  grid.clearance_m = clearances_m(blocked, 0.05);
  grid.occupant = Grid2d<std::uint16_t>(120, 40);
  const auto way = way_to_look_around(grid, {{1.0, 1.0}, {3.0, 1.0}});
  ASSERT_TRUE(way);
  EXPECT_EQ(way->front(), Vector2d(3.0, 1.0));
  EXPECT_GT(way->back().x(), 4.5);  // away from both
  Grid2d<float> none(120, 40, 0.0F);
  grid.clearance_m = none;
  EXPECT_FALSE(way_to_look_around(grid, {{3.0, 1.0}}));
}

TEST(PlaceBelief, OneAnswerIsNotBelievedFiveThatAgreeAre) {
  PlaceBelief belief;
  const auto at = [](double x) { return Pose2{{x, 0}, 0}; };
  for (int i = 0; i < 4; ++i) belief.see(at(5 + 0.1 * i), at(0.1 * i));
  EXPECT_FALSE(belief.known());
  belief.see(at(9), at(0.4));  // at a different place: it starts over
  for (int i = 0; i < 4; ++i) {
    EXPECT_FALSE(belief.known());
    belief.see(at(5.5 + 0.1 * i), at(0.5 + 0.1 * i));
  }
  belief.see(at(5.9), at(0.9));
  ASSERT_TRUE(belief.known());
  EXPECT_NEAR((belief.map_from_odom() * at(1.0)).place_m.x(), 6.0, 1e-9);
  belief.see(at(20), at(1.0));  // a single pose that disagrees changes nothing
  EXPECT_NEAR((belief.map_from_odom() * at(1.0)).place_m.x(), 6.0, 1e-9);
  for (int i = 0; i < 50; ++i) belief.see(std::nullopt, at(1.0 + 0.1 * i));
  EXPECT_FALSE(belief.known());  // after 5 m without any answer
}

}  // namespace
}  // namespace mh
