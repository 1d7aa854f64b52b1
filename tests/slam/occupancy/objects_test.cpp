// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/objects.hpp"

#include <gtest/gtest.h>

#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/occupancy/floor_frame.hpp"
#include "tests/slam/occupancy/box_room.hpp"
#include "tests/slam/occupancy/made_map.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr ClassId kFridge = 24, kPerson = 31;

/// A floor, two chairs, a table with thin legs, a refrigerator, a person; moved by `by` voxels.
MadeMap furnished(const Vector3i& by) {
  MadeMap made;
  made.box(Vector3i(0, 0, -1) + by, Vector3i(80, 80, -1) + by, kFloorLabel);
  for (const int x : {5, 30})
    made.box(Vector3i(x, 5, 0) + by, Vector3i(x + 8, 13, 16) + by, kChair);
  made.box(Vector3i(50, 5, 14) + by, Vector3i(74, 20, 15) + by, kTable);
  for (const int x : {52, 72}) made.box(Vector3i(x, 12, 0) + by, Vector3i(x, 12, 10) + by, kTable);
  made.box(Vector3i(10, 60, 0) + by, Vector3i(22, 72, 34) + by, kFridge);
  made.box(Vector3i(60, 60, 0) + by, Vector3i(68, 68, 34) + by, kPerson);
  made.box(Vector3i(40, 40, 3) + by, Vector3i(41, 40, 3) + by, kFridge);  // label noise
  return made;
}

TEST(FindObjects, ObjectsAreClustersOfTheirClass) {
  const std::vector<MapObject> objects = find_objects(furnished({0, 0, 0}).map());
  ASSERT_EQ(objects.size(), 4u);
  EXPECT_EQ(objects[0].name, "chair 1");
  EXPECT_EQ(objects[1].name, "chair 2");
  EXPECT_EQ(objects[2].class_id, kTable);  // the legs belong to it
  EXPECT_NEAR(objects[2].min_m.z(), 0.0, 1e-9);
  EXPECT_NEAR(objects[2].max_m.z(), 0.8, 1e-9);
  EXPECT_EQ(objects[3].class_id, kFridge);
  EXPECT_LT((objects[3].center_m - Vector3d(0.825, 3.325, 0.875)).norm(), 1e-9);
  EXPECT_EQ(objects[3].voxels, 13u * 13 * 35);
  EXPECT_DOUBLE_EQ(objects[3].score, 1.0);
}

TEST(FindObjects, TheyMoveWithTheMap) {
  const Vector3i by(-13, 7, 2);
  const std::vector<MapObject> here = find_objects(furnished({0, 0, 0}).map()),
                               there = find_objects(furnished(by).map());
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_EQ(here[i].name, there[i].name);
    EXPECT_LT((there[i].center_m - here[i].center_m - 0.05 * by.cast<double>()).norm(), 1e-9);
  }
}

std::string why_not(const std::vector<MapObject>& objects, const std::string& name) {
  try {
    objects_named(objects, name);
    return "found";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(ObjectsNamed, FindsByClassSynonymAndName) {
  const std::vector<MapObject> objects = find_objects(furnished({0, 0, 0}).map());
  EXPECT_EQ(objects_named(objects, "fridge"), std::vector<std::size_t>{3});
  EXPECT_EQ(objects_named(objects, "refrigerator"), std::vector<std::size_t>{3});
  EXPECT_EQ(objects_named(objects, "chair").size(), 2u);
  EXPECT_EQ(objects_named(objects, "chair 2"), std::vector<std::size_t>{1});
  EXPECT_NE(why_not(objects, "tabel").find("did you mean 'table'"), std::string::npos)
      << why_not(objects, "tabel");
  EXPECT_NE(why_not(objects, "sofa").find("the map holds none"), std::string::npos);
  EXPECT_EQ(objects_named(objects, "FRIDGE"), std::vector<std::size_t>{3});
  EXPECT_EQ(objects_named(objects, "Chair_2"), std::vector<std::size_t>{1});
  EXPECT_NE(why_not(objects, "wall").find("is never an object in a map"), std::string::npos);
  EXPECT_NE(objects_json(objects, 0.05).find("\"name\": \"chair 2\""), std::string::npos);
}

/// Points of a room whose frame is tilted against gravity, like the frame of a first camera.
struct MadeRoom {
  explicit MadeRoom(ClassId of_floor, ClassId of_table = kTable) {
    const RandomStream draws(3);
    const auto add = [&](const Vector3d& at, ClassId label) {
      points.push_back({world_from_room * at, label});
    };
    for (std::uint64_t i = 0; i < 600; ++i) {
      const double x = draws.uniform(4 * i, -2, 2), y = draws.uniform(4 * i + 1, -2, 2),
                   noise = 0.01 * draws.normal(4 * i + 2);
      add({x, y, noise}, of_floor);
      if (i < 300) add({x / 4 + 1, y / 4, 0.75 + noise}, of_table);
      if (i < 300) add({2, y, x / 2 + 1.1}, kWallLabel);
    }
    for (int i = 0; i < 8; ++i)
      cameras.push_back(world_from_room *
                        SE3(room_pose(i * 0.8).rotation(), Vector3d(0.1 * i, 0.2, 1.1)));
  }
  SE3 world_from_room = SE3::exp((Vector6d() << 0.3, -0.2, 1.0, 0.4, -0.3, 0.9).finished());
  std::vector<LabeledPoint> points;
  std::vector<SE3> cameras;
};

void expect_floor(const MadeRoom& room, bool by_labels) {
  const auto floor = find_floor_frame(room.points, room.cameras);
  ASSERT_TRUE(floor);
  EXPECT_EQ(floor->by_labels, by_labels);
  const SE3 floor_from_room = floor->floor_from_world * room.world_from_room;
  EXPECT_NEAR(floor_from_room.translation().z(), 0.0, 0.01);
  EXPECT_GT(floor_from_room.rotation()(2, 2), std::cos(0.02));
  const SE3 first = floor->floor_from_world * room.cameras[0];
  EXPECT_LT(first.translation().head<2>().norm(), 1e-9);
  EXPECT_GT(first.rotation()(0, 2), 0.99);  // the robot looks along x
}

TEST(FloorFrame, IsFoundByLabels) {
  expect_floor(MadeRoom(kFloorLabel), true);
}
TEST(FloorFrame, IsFoundByGeometryWithoutLabels) {
  expect_floor(MadeRoom(kVoid, kVoid), false);
}
TEST(FloorFrame, LabelsThatMisleadDoNotCount) {
  expect_floor(MadeRoom(kVoid, kFloorLabel),
               false);  // a table is labeled floor, but there are points below it
}
TEST(FloorFrame, WithoutAPlaneThereIsNone) {
  MadeRoom room(kFloorLabel);
  room.points.resize(10);
  EXPECT_FALSE(find_floor_frame(room.points, room.cameras));
  EXPECT_FALSE(find_floor_frame(room.points, {}));
}
TEST(FloorFrame, ASliceOfWallsIsNoFloor) {
  MadeRoom room(kVoid, kVoid);
  room.points.clear();  // a level camera sees walls from 0.4 m upward, and no floor
  const RandomStream draws(9);
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const double along = draws.uniform(3 * i, -2, 2), z = draws.uniform(3 * i + 1, 0.4, 1.8);
    const double side = i % 2 == 0 ? -2 : 2;
    const Vector3d at = i % 4 < 2 ? Vector3d(side, along, z) : Vector3d(along, side, z);
    room.points.push_back({room.world_from_room * at, kVoid});
  }
  EXPECT_FALSE(find_floor_frame(room.points, room.cameras));
}

}  // namespace
}  // namespace mh
