// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/laser_scans.hpp"

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;

/// The camera's pose when Pepper's base is at this place and faces along x.
SE3 camera_at(const Robot& robot, const Vector3d& base_m) {
  return SE3(Eigen::Matrix3d::Identity(), base_m) * robot.base_from_camera;
}

std::int8_t cell_at(const ScanGrid& scans, double x_m, double y_m) {
  OccupancyGrid grid;
  scans.add_to(grid);
  const auto cell = grid.cell_of({x_m, y_m});
  return cell ? grid.cells(cell->x(), cell->y()) : kUnknownCell;
}

/// A room with a box 1.52 m in front of the place (5, 5); its floor may be raised by `floor_m`.
Scene room_with_box(float floor_m = 0) {
  Scene scene = test::empty_room();
  test::add_box(scene, "box", {6.52F, 4, 0}, {7, 6, 1});
  for (Eigen::Vector3f& p : scene.positions_m) p.z() += floor_m;
  scene.floor.middle_m.z() = floor_m;
  return scene;
}

TEST(SceneLasers, WhatTheyReadStandsWhereThePoseSays) {
  const Robot robot = test::pepper();
  const Scene scene = room_with_box();
  const SceneLasers lasers(scene, robot);
  const Trajectory truth = {{10, camera_at(robot, {5, 5, 0})}, {20, camera_at(robot, {5, 5, 0})}};
  const ScanGrid right = lasers.scans({truth[0]}, truth, 0.05);
  EXPECT_EQ(cell_at(right, 6.52, 5.02), kOccupiedCell);
  EXPECT_EQ(cell_at(right, 6.02, 5.02), kFreeCell);
  EXPECT_EQ(cell_at(right, 6.72, 5.02), kUnknownCell);  // behind the face of the box
  // The map places the robot one meter farther north.
  const ScanGrid moved = lasers.scans({{20, camera_at(robot, {5, 6, 0})}}, truth, 0.05);
  EXPECT_EQ(cell_at(moved, 6.52, 6.02), kOccupiedCell);
  EXPECT_EQ(cell_at(moved, 6.02, 6.02), kFreeCell);
  // At any other time, there are no laser readings.
  EXPECT_EQ(cell_at(lasers.scans({{15, camera_at(robot, {5, 5, 0})}}, truth, 0.05), 6.02, 5.02),
            kUnknownCell);
}

TEST(SceneLasers, AFloorMayBeAnywhere) {
  const Robot robot = test::pepper();
  const Scene scene = room_with_box(2);
  const SceneLasers lasers(scene, robot);
  const Trajectory truth = {{10, camera_at(robot, {5, 5, 2})}};
  EXPECT_EQ(cell_at(lasers.scans(truth, truth, 0.05), 6.52, 5.02), kOccupiedCell);
}

TEST(SceneLasers, ARobotWithoutIsRefused) {
  Robot robot = test::pepper();
  auto equipment = std::make_shared<Equipment>(*robot.equipment);
  equipment->lasers.clear();
  robot.equipment = equipment;
  const Scene scene = room_with_box();
  try {
    const SceneLasers lasers(scene, robot);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "robot 'pepper' has no lasers (its file: equipment.lasers)");
  }
}

}  // namespace
}  // namespace mh
