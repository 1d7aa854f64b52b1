// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/lasers_along.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using test::add_box;
using test::empty_room;
using test::pepper;

SE3 turned(double heading_rad, const Eigen::Vector3d& at_m) {
  return {Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix(), at_m};
}

/// The robot turns next to a wall while its head nods.
DrivenPath turning(const Robot& robot) {
  DrivenPath path;
  for (int i = 0; i < 5; ++i) {
    const SE3 world_from_base = turned(0.1 * i, {5, 5, 0});
    const SE3 nod(Eigen::AngleAxisd(0.05 * i, Eigen::Vector3d::UnitX()).toRotationMatrix(),
                  Eigen::Vector3d::Zero());
    path.base.push_back({i * 33'333'333L, world_from_base});
    path.camera.push_back({i * 33'333'333L, world_from_base * robot.base_from_camera * nod});
  }
  return path;
}

// The end of a ray is on the wall wherever the head looks.
TEST(LasersAlong, PlaceWhatTheyMeasureByTheCamera) {
  Scene scene = empty_room();
  add_box(scene, "wall", {7, 0, 0}, {7.2F, 10, 2});
  const Robot robot = pepper();
  const DrivenPath path = turning(robot);
  const LasersAlong lasers(std::make_shared<const Scene>(scene), robot, path, 0);
  int on_the_wall = 0;
  for (std::size_t i = 0; i < path.base.size(); ++i)
    for (const LaserScan& scan : lasers.at(i))
      for (std::size_t k = 0; k < scan.ranges_m.size(); ++k) {
        if (scan.ranges_m[k] == 0) continue;
        const double a = scan.first_rad + static_cast<double>(k) * scan.step_rad;
        const Eigen::Vector3d end_m =
            path.camera[i].world_from_camera * scan.camera_from_laser *
            (scan.ranges_m[k] * Eigen::Vector3d(std::cos(a), std::sin(a), 0));
        EXPECT_NEAR(end_m.x(), 7, 1e-4) << i << " " << scan.name << " " << k;
        ++on_the_wall;
      }
  EXPECT_EQ(on_the_wall, 5 * 15);
  EXPECT_EQ(lasers.at(0).size(), 3U);
  EXPECT_EQ(lasers.at(0)[0].max_range_m, 3.0);
}

TEST(LasersAlong, SeeWhoWalksByAtThatMomentInAnyOrder) {
  const Robot robot = pepper();
  const MovingObstacle person{
      .path = [](double time_s) { return Eigen::Vector2d(7 + 3 * time_s, 5); }};
  const LasersAlong lasers(std::make_shared<const Scene>(empty_room()), robot, turning(robot), 0,
                           {person});
  const auto ahead_m = [&](std::size_t i) { return lasers.at(i)[0].ranges_m[7]; };
  const float later_m = ahead_m(1), first_m = ahead_m(0);
  EXPECT_NEAR(first_m, 2 - 0.22 - 0.0562, 5e-3);  // the cylinder has flat faces
  EXPECT_GT(later_m, first_m + 0.05F);
  EXPECT_EQ(ahead_m(1), later_m);
}

TEST(LasersAlong, NeedLasers) {
  Robot robot = pepper();
  auto equipment = std::make_shared<Equipment>(*robot.equipment);
  equipment->lasers.clear();
  robot.equipment = equipment;
  EXPECT_THROW(
      LasersAlong(std::make_shared<const Scene>(empty_room()), robot, turning(pepper()), 0),
      InputError);
}

}  // namespace
}  // namespace mh
