// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/episodes/robot_map.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/occupancy/obstacle_grid.hpp"
#include "tests/slam/occupancy/made_map.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr double kReach_m = 1.5;

/// Two rooms of 3 x 2 m on the two sides of y = 2 m, separated by a 10 cm wall that begins at x =
/// 0. A refrigerator is flush against the far side of the wall.
VoxelMap refrigerator_behind_a_wall(int wall_cells) {
  MadeMap made;
  for (int x = 0; x < 60; ++x)
    for (int y = 0; y < 82; ++y)
      for (int z = 0; z < 24; ++z) made.free({x, y, z});
  made.box({0, 40, 0}, {wall_cells - 1, 41, 30}, *class_by_name("wall"));
  made.box({10, 42, 0}, {21, 53, 20}, *class_by_name("refrigerator"), 1);
  return made.map();
}

TEST(KnownMap, AnObjectBehindAWallIsReachedFromItsOwnSide) {
  const VoxelMap map = refrigerator_behind_a_wall(40);
  const std::vector<MapObject> objects = find_objects(map);
  ASSERT_EQ(objects.size(), 1U);
  const KnownMap known = known_map(map, obstacle_grid(map));
  const std::vector<Vector2d> footprint_m = footprints_of(map, objects)[0];
  EXPECT_EQ(footprint_m.size(), 144U);
  const Grid2d<float> away_m = distances_m(known, footprint_m, kReach_m);
  const auto away = [&](const Vector2d& place_m) {
    const auto cell = known.grid.cell_of(place_m);
    return away_m(cell->first, cell->second);
  };
  EXPECT_TRUE(std::isinf(away({0.8, 1.6})));  // 0.5 m away, behind the wall
  EXPECT_NEAR(away({0.8, 3.175}), 0.5, 0.03);

  const Vector2d from_m(0.8, 1.0);
  const auto place_m = place_before(known.grid, away_m, from_m, 0.31, kReach_m);
  ASSERT_TRUE(place_m);
  EXPECT_GT(place_m->y(), 2.1);  // the path leads around the end of the wall
}

TEST(KnownMap, NoPlaceIsBeforeAnObjectInAClosedRoom) {
  const VoxelMap map = refrigerator_behind_a_wall(60);
  const KnownMap known = known_map(map, obstacle_grid(map));
  const Grid2d<float> away_m =
      distances_m(known, footprints_of(map, find_objects(map))[0], kReach_m);
  EXPECT_FALSE(place_before(known.grid, away_m, {0.8, 1.0}, 0.31, kReach_m));
}

}  // namespace
}  // namespace mh
