// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "robots/navigation/plan.hpp"
#include "sim/motion/floor_grid.hpp"
#include "slam/io/error.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using test::add_box;
using test::empty_room;

double length_m(const std::vector<Vector2d>& way) {
  double sum = 0;
  for (std::size_t i = 1; i < way.size(); ++i) sum += (way[i] - way[i - 1]).norm();
  return sum;
}

/// A room divided by a wall that has a door.
Scene two_rooms(float door_m) {
  Scene scene = empty_room();
  add_box(scene, "wall south of the door", {4.9F, 0, 0}, {5.1F, 7, 2.5F});
  add_box(scene, "wall north of the door", {4.9F, 7 + door_m, 0}, {5.1F, 10, 2.5F});
  add_box(scene, "lintel", {4.9F, 7, 2}, {5.1F, 7 + door_m, 2.5F});
  return scene;
}

// "x" is free. Cells are connected by their sides, not by their corners, up to the edges of the
// grid.
TEST(LargestRegion, IsConnectedBySides) {
  const std::vector<std::string> rows{"xx.x", "x..x", ".xx."};
  FloorGrid grid;
  grid.clearance_m = Grid2d<float>(4, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x)
      grid.clearance_m(x, y) =
          rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == 'x';
  const auto marked = [&](double clearance_m) {
    std::string cells;
    for (const std::uint8_t cell : largest_region(grid, clearance_m))
      cells += cell != 0 ? 'x' : '.';
    return cells;
  };
  EXPECT_EQ(marked(0.5),
            "xx.."
            "x..."
            "....");
  EXPECT_EQ(marked(1.5), std::string(12, '.'));
  // A single cell is a region, even in the first row or column.
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(3, 0), std::pair(0, 2)}) {
    grid.clearance_m = Grid2d<float>(4, 3);
    grid.clearance_m(x, y) = 1;
    std::string alone(12, '.');
    alone[static_cast<std::size_t>(4 * y + x)] = 'x';
    EXPECT_EQ(marked(0.5), alone);
  }
}

TEST(FloorGrid, ClearanceIsTheDistanceToTheNearestObstacleOrLess) {
  Scene scene = empty_room();
  add_box(scene, "pillar", {4, 4, 0}, {4.5F, 4.5F, 1});
  const FloorGrid grid = make_floor_grid(scene);
  for (double x = 0.3; x < 9.8; x += 0.37)
    for (double y = 0.3; y < 9.8; y += 0.41) {
      const Vector2d p(x, y);
      const double wall_m = std::min(p.minCoeff(), (Vector2d(10, 10) - p).minCoeff());
      const Vector2d outside = (Vector2d(4, 4) - p).cwiseMax(p - Vector2d(4.5, 4.5)).cwiseMax(0.0);
      const double truth_m = std::min(wall_m, outside.norm());
      // A cell is blocked as soon as anything touches it, and a place gets the clearance of its
      // cell's center. So the clearance is at most two cells too small, and never too large by more
      // than half a diagonal.
      EXPECT_LE(grid.clearance_at(p), truth_m + 0.72 * grid.resolution_m) << p.transpose();
      EXPECT_GE(grid.clearance_at(p), truth_m - 2.2 * grid.resolution_m) << p.transpose();
    }
  EXPECT_EQ(grid.clearance_at({4.25, 4.25}), 0.0);
  EXPECT_EQ(grid.clearance_at({-5, 3}), 0.0);
  EXPECT_EQ(occupant_near(grid, scene, {3.9, 4.2}, 0.3), " against pillar");
}

TEST(FloorGrid, WhatIsBelowTheFootOrAboveTheHeadIsNoObstacle) {
  Scene scene = empty_room();
  add_box(scene, "rug", {3, 3, 0}, {5, 5, 0.02F});
  add_box(scene, "lamp", {6, 6, 1.3F}, {7, 7, 1.8F});
  add_box(scene, "table top", {7, 2, 0.7F}, {8, 3, 0.75F});
  const FloorGrid grid = make_floor_grid(scene);
  EXPECT_GT(grid.clearance_at({4, 4}), 2.0);
  EXPECT_GT(grid.clearance_at({6.5, 6.5}), 2.0);
  EXPECT_EQ(grid.clearance_at({7.5, 2.5}), 0.0);
}

TEST(FloorGrid, WithoutAFloorThereIsNoGrid) {
  Scene scene;
  scene.name = "void";
  EXPECT_THROW(make_floor_grid(scene), InputError);
  EXPECT_THROW(make_floor_grid(empty_room(), {.resolution_m = 0}), InputError);
}

TEST(PlanWay, GoesThroughTheDoorAndKeepsItsDistance) {
  const Scene scene = two_rooms(0.9F);
  const FloorGrid grid = make_floor_grid(scene);
  const auto way = plan_way(grid, {2, 2}, {8, 2}, 0.30);
  ASSERT_TRUE(way.has_value());
  EXPECT_EQ(way->front(), Vector2d(2, 2));
  EXPECT_EQ(way->back(), Vector2d(8, 2));
  for (std::size_t i = 1; i < way->size(); ++i)
    EXPECT_TRUE(grid.clear_line((*way)[i - 1], (*way)[i], 0.29)) << i;
  // The path is about as long as the straight path through the middle of the door.
  const double straight_m = 2 * std::hypot(3, 5.45);
  EXPECT_GT(length_m(*way), straight_m - 0.5);
  EXPECT_LT(length_m(*way), straight_m * 1.1);
  EXPECT_LT(way->size(), 12U);
}

TEST(PlanWay, ThereIsNoneThroughADoorThatIsTooNarrow) {
  const FloorGrid grid = make_floor_grid(two_rooms(0.5F));
  EXPECT_FALSE(plan_way(grid, {2, 2}, {8, 2}, 0.26).has_value());
  EXPECT_FALSE(plan_way(grid, {2, 2}, {5, 2}, 0.26).has_value());   // inside the wall
  EXPECT_FALSE(plan_way(grid, {2, 2}, {50, 2}, 0.26).has_value());  // outside the house
  EXPECT_TRUE(plan_way(grid, {2, 2}, {2, 9}, 0.26).has_value());
}

TEST(PlanWay, APointDoesNotGoThroughWallsEither) {
  const FloorGrid grid = make_floor_grid(two_rooms(0.5F));
  EXPECT_FALSE(plan_way(grid, {2, 2}, {5, 2}, 0).has_value());
  const auto way = plan_way(grid, {2, 2}, {8, 2}, 0);
  ASSERT_TRUE(way.has_value());
  EXPECT_GT(length_m(*way), 11.0);  // through the door
}

TEST(PlanWay, RoundTripsAreNoLongerThanTheOrderGiven) {
  const FloorGrid grid = make_floor_grid(empty_room());
  // Twelve places on a circle, in a scrambled order: the tour is the polygon on the circle.
  std::vector<Vector2d> places;
  for (int i = 0; i < 12; ++i) {
    const double a = 2 * M_PI * ((i * 5) % 12) / 12;
    places.emplace_back(5 + 3 * std::cos(a), 5 + 3 * std::sin(a));
  }
  const auto [order, length_m] = round_trip(lengths_between(grid, places, 0.3), places.size());
  ASSERT_EQ(order.size(), places.size());
  double sum = 0;
  for (std::size_t i = 0; i < order.size(); ++i)
    sum += (places[order[i]] - places[order[(i + 1) % order.size()]]).norm();
  EXPECT_NEAR(sum, 12 * 2 * 3 * std::sin(M_PI / 12), 1e-6);
  EXPECT_NEAR(length_m / sum, 1.05, 0.06);  // steps of 45 deg make paths up to 8 % longer
  EXPECT_EQ(order.front(), 0U);
}

TEST(LargestRegion, IsTheOneWithTheMostFloor) {
  const FloorGrid grid = make_floor_grid(two_rooms(0.5F));
  const auto region = largest_region(grid, 0.3);
  const auto at = [&](const Vector2d& p) {
    const auto cell = grid.cell_of(p);
    return region(cell->first, cell->second);
  };
  EXPECT_EQ(at({2, 2}) + at({8, 2}), 1);
  const auto places = spread_places(grid, region, 1.0, 10, 3);
  EXPECT_EQ(places.size(), 10U);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(at(places[i]), 1);
    for (std::size_t k = 0; k < i; ++k) EXPECT_GE((places[i] - places[k]).norm(), 1.0);
  }
}

}  // namespace
}  // namespace mh
