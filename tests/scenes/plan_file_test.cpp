// SPDX-License-Identifier: Apache-2.0
#include "scenes/house/plan_file.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "slam/io/yaml.hpp"

namespace mh {
namespace {

/// Two rooms with everything that a file can contain.
HouseFile two_rooms() {
  HouseFile house;
  house.comment = "two rooms";
  house.name = "two";
  house.extent = {0, 0, 7.1, 4};
  house.height_m = 2.6;
  house.materials = {{.name = "wood_1", .kind = "wood_grain", .tone = {180, 130, 90}, .seed = 7},
                     {.name = "paint_2", .kind = "plaster", .tone = {230, 230, 220}}};
  house.rooms.resize(2);
  RoomEntry &west = house.rooms[0], &east = house.rooms[1];
  west.name = "west", west.rect = {0, 0, 4, 4}, west.cut = FloorRect{0, 2.5, 1.5, 4};
  east.name = "east", east.rect = {4.1, 0, 7.1, 4};
  for (RoomEntry& room : house.rooms) room.floor = room.ceiling = room.walls = "paint_2";
  west.special_walls[Side::kEast] = "wood_1";
  ItemEntry table, lamp;
  table.name = table.kind = "desk";
  table.at_m = {2.5, 0.5}, table.turn_deg = 180, table.size_m = {1.4, 0.7, 0.74};
  table.materials["wood"] = "wood_1";
  lamp.name = "lamp", lamp.kind = "table_lamp", lamp.on = "desk";
  lamp.at_m = {-0.3, 0.1}, lamp.size_m = {0.25, 0.25, 0.45};
  lamp.glow = Eigen::Vector3d(0.2, 0.16, 0.1);
  west.items = {table, lamp};
  house.doorways.resize(2);
  OpeningPlan &inner = house.doorways[0], &outer = house.doorways[1];
  inner.name = "inner", inner.other = 1, inner.from_m = 1, inner.to_m = 1.9, inner.high_m = 2;
  outer.name = "outer", outer.room = 1, outer.side = Side::kSouth, outer.closed = true;
  outer.from_m = 5, outer.to_m = 5.9, outer.high_m = 2.1;
  house.windows.resize(1);
  OpeningPlan& window = house.windows[0];
  window.name = "window", window.side = Side::kWest, window.from_m = 0.5, window.to_m = 2;
  window.low_m = 0.9, window.high_m = 2.1, window.panes = 2;
  house.trim = house.window_frame = "wood_1";
  house.garden = {.material = "paint_2", .distance_m = 9, .height_m = 6, .glow = 0.05};
  house.sun = {{0.1, 0.2, -0.7}, {9, 8.5, 7}};
  house.sky = Eigen::Vector3d(5, 6, 7);
  house.detail = 1.5;
  return house;
}

TEST(PlanFile, WhatIsWrittenIsReadBack) {
  const HouseFile file = two_rooms();
  const HousePlan plan = read_house_plan(YamlReader::parse(to_yaml(file), "two.yaml"));
  EXPECT_EQ(plan.name, "two");
  EXPECT_EQ(plan.extent.x1, 7.1);
  EXPECT_EQ(plan.height_m, 2.6);
  EXPECT_EQ(plan.detail, 1.5);
  ASSERT_EQ(plan.rooms.size(), 2U);
  ASSERT_TRUE(plan.rooms[0].cut);
  EXPECT_EQ(plan.rooms[0].cut->y0, 2.5);
  EXPECT_EQ(plan.rooms[0].walls[static_cast<std::size_t>(Side::kEast)].name, "wood_1");
  EXPECT_EQ(plan.rooms[0].walls[static_cast<std::size_t>(Side::kWest)].seed, 0U);
  EXPECT_EQ(plan.rooms[1].rect.x0, 4.1);
  ASSERT_EQ(plan.items.size(), 2U);
  EXPECT_EQ(plan.items[0].materials.at("wood").seed, 7U);
  EXPECT_EQ(plan.items[0].size_m, file.rooms[0].items[0].size_m);
  ASSERT_EQ(plan.items[1].on, 0U);
  EXPECT_NEAR(plan.items[1].position_m.x(), 2.5 + 0.3,
              1e-12);  // the desk is rotated by 180 degrees
  EXPECT_NEAR(plan.items[1].turn_rad, std::numbers::pi, 1e-12);
  ASSERT_TRUE(plan.items[1].glow);
  ASSERT_EQ(plan.doorways.size(), 2U);
  EXPECT_EQ(plan.doorways[0].side, Side::kEast);
  EXPECT_EQ(plan.doorways[0].other, 1U);
  EXPECT_TRUE(plan.doorways[1].closed);
  ASSERT_EQ(plan.windows.size(), 1U);
  EXPECT_EQ(plan.windows[0].panes, 2);
  EXPECT_EQ(plan.windows[0].high_m, 2.1);
  ASSERT_TRUE(plan.garden);
  EXPECT_EQ(plan.garden->glow, 0.05);
  ASSERT_TRUE(plan.sun);
  EXPECT_EQ(plan.sun->color.x(), 9.0F);
  ASSERT_TRUE(plan.sky);
}

}  // namespace
}  // namespace mh
