// SPDX-License-Identifier: Apache-2.0
#include "robots/navigation/navigator.hpp"

#include <cmath>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "robots/navigation/smooth.hpp"
#include "slam/io/error.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

/// A 6 x 4 m floor divided by a wall with a gap; serves as the world and as its map.
struct Flat {
  double resolution_m = 0.05;
  Grid2d<std::uint8_t> solid{120, 80};
  Flat() {
    for (int y = 0; y < 80; ++y)
      for (int x = 0; x < 120; ++x)
        solid(x, y) = x < 2 || y < 2 || x > 117 || y > 77 || (x > 58 && x < 62 && y < 50);
  }
  bool is_solid(const Vector2d& p) const {
    const int x = static_cast<int>(std::lround(p.x() / resolution_m));
    const int y = static_cast<int>(std::lround(p.y() / resolution_m));
    return !solid.contains(x, y) || solid(x, y) != 0;
  }
  KnownMap map() const {
    KnownMap known;
    known.grid.resolution_m = resolution_m;
    known.blocked = solid;
    known.grid.clearance_m = clearances_m(solid, resolution_m);
    known.grid.occupant = Grid2d<std::uint16_t>(120, 80);
    return known;
  }
};

NavigatorGoal box_at(double x, double y) {
  NavigatorGoal goal{"box 1", {}};
  for (double dx = -0.2; dx < 0.21; dx += 0.05)
    for (double dy = -0.2; dy < 0.21; dy += 0.05) goal.places_m.emplace_back(x + dx, y + dy);
  return goal;
}

/// A robot that carries out commands, with lasers in the flat world. The frame of its odometry is
/// not the frame of the map.
class Driven {
 public:
  Driven(const Flat& world, const Robot& robot, Pose2 start)
      : world_(world), robot_(robot), at_(std::move(start)) {}
  bool answers = true;                        ///< the SLAM system reports its pose
  std::function<bool(double)> bumper = {};    ///< state of the first bumper at a time
  std::function<void(Twist2d&)> wheels = {};  ///< changes a command as the wheels carry it out

  /// Runs until the navigator ends, or for `limit_s` seconds.
  void run(Navigator& navigator, double limit_s) {
    Twist2d command = Twist2d::Zero();
    for (time_s = 0; time_s < limit_s && !is_end(navigator.state()); time_s += 0.1) {
      if (wheels) wheels(command);
      Vector2d step = 0.1 * command.head<2>();
      if (!world_.is_solid(at_ * (step + 0.26 * step.normalized()))) at_.place_m = at_ * step;
      at_.heading_rad = std::remainder(at_.heading_rad + 0.1 * command.z(), 2 * M_PI);
      nearest_m = std::min(nearest_m, clearance());
      const std::vector<std::vector<float>> lasers_m = scan();
      Perception now{.time_s = time_s,
                     .odom_from_base = odometry(),
                     .lasers_m = lasers_m,
                     .bumpers = {bumper && bumper(time_s), false, false},
                     .seen = {}};
      now.seen = Perception::Seen{nullptr, odometry(), {}};
      if (answers) now.seen->map_from_base = at_;
      command = navigator.step(now);
      EXPECT_LE(command.head<2>().norm(), robot_.limits.max_velocity_m_per_s + 1e-9);
      for (std::string& line : navigator.take_said()) said += line + "\n";
    }
  }
  const Pose2& at() const { return at_; }
  std::string said;
  double time_s = 0, nearest_m = 1e9;

 private:
  Pose2 odometry() const { return Pose2{{7, -3}, 1.2} * at_; }
  double clearance() const {
    double best = 1e9;
    for (int y = 0; y < 80; ++y)
      for (int x = 0; x < 120; ++x)
        if (world_.solid(x, y) != 0)
          best = std::min(best, (0.05 * Vector2d(x, y) - at_.place_m).norm());
    return best;
  }
  std::vector<std::vector<float>> scan() const {
    std::vector<std::vector<float>> all;
    for (const LaserScanner& laser : robot_.equipment->lasers) {
      const Pose2 from = at_ * from_above(laser.base_from_laser);
      all.emplace_back();
      for (int k = 0; k < laser.rays; ++k) {
        const double a =
            from.heading_rad + laser.field_of_view_rad * (k / (laser.rays - 1.0) - 0.5);
        float range_m = 0;
        for (double r = laser.min_range_m; r < laser.max_range_m; r += 0.01)
          if (world_.is_solid(from.place_m + r * Vector2d(std::cos(a), std::sin(a)))) {
            range_m = static_cast<float>(r);
            break;
          }
        all.back().push_back(range_m);
      }
    }
    return all;
  }

  const Flat& world_;
  const Robot& robot_;
  Pose2 at_;
};

TEST(Navigator, DrivesThroughTheGapAndSaysThatItHasArrived) {
  const Flat flat;
  const Robot robot = test::pepper();
  const KnownMap map = flat.map();
  Navigator navigator(map, robot, {box_at(5.0, 0.6)});
  Driven driven(flat, robot, {{1, 1}, 2.0});
  driven.run(navigator, 120);
  EXPECT_EQ(navigator.state(), NavigatorState::kArrived) << driven.said;
  EXPECT_LT((driven.at().place_m - Vector2d(5.0, 0.6)).norm(), 0.9 + 0.2);
  EXPECT_GT(driven.nearest_m, 0.27);
  EXPECT_NE(driven.said.find("knows its place"), std::string::npos);
  EXPECT_NE(driven.said.find("has arrived at box 1"), std::string::npos);
}

TEST(Navigator, TakesANarrowDoorInPlaceOfALongWay) {
  Flat flat;
  for (int x = 59; x < 62;
       ++x)  // 0.65 m: enough for the smallest margin, not for the preferred one
    for (int y = 9; y < 22; ++y) flat.solid(x, y) = 0;
  const Robot robot = test::pepper();
  const KnownMap map = flat.map();
  Navigator navigator(map, robot, {box_at(5.0, 0.6)});
  Driven driven(flat, robot, {{1, 0.6}, 0.0});
  driven.run(navigator, 3);
  EXPECT_LT(length_m(navigator.path()), 5.0)
      << driven.said;  // the path through the wide gap is 8 m
  driven.run(navigator, 60);
  EXPECT_EQ(navigator.state(), NavigatorState::kArrived) << driven.said;
  EXPECT_GT(driven.nearest_m, 0.27);
}

TEST(Navigator, LostItLooksAroundElsewhere) {
  const Flat flat;
  const Robot robot = test::pepper();
  const KnownMap map = flat.map();
  Navigator navigator(map, robot, {box_at(5.0, 0.6)});
  Driven driven(flat, robot, {{1, 1}, 2.0});
  driven.answers = false;
  driven.run(navigator, 60);
  EXPECT_FALSE(navigator.knows_its_place());
  EXPECT_FALSE(is_end(navigator.state())) << driven.said;
  EXPECT_NE(driven.said.find("is lost: drives"), std::string::npos) << driven.said;
  EXPECT_GT((driven.at().place_m - Vector2d(1, 1)).norm(), 0.5);
  EXPECT_GT(driven.nearest_m, 0.27);
}

TEST(Navigator, AGoalInAWallOrBeyondTheMapIsRefused) {
  const Flat flat;
  const Robot robot = test::pepper();
  const KnownMap map = flat.map();
  for (const NavigatorGoal& goal : {box_at(9.0, 1.0), box_at(-3, -3)}) try {
      Navigator(map, robot, {goal});
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("goal 'box 1'"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("inside a wall or in space that the map does not"),
                std::string::npos);
    }
}

TEST(Navigator, ATwoWheeledRobotWithoutBumpersArrivesToo) {
  const Flat flat;
  const Robot robot = test::turtlebot();
  const KnownMap map = flat.map();
  Navigator navigator(map, robot, {box_at(5.0, 0.6)});
  Driven driven(flat, robot, {{1, 1}, 2.0});
  driven.wheels = [](Twist2d& command) { EXPECT_EQ(command.y(), 0); };
  driven.run(navigator, 180);
  EXPECT_EQ(navigator.state(), NavigatorState::kArrived) << driven.said;
  EXPECT_LT((driven.at().place_m - Vector2d(5.0, 0.6)).norm(), 0.9 + 0.2);
  EXPECT_GT(driven.nearest_m, robot.footprint_radius_m);
}

TEST(Navigator, ATwoWheeledRobotBacksStraightOff) {
  const Flat flat;
  Robot robot = test::turtlebot();
  auto equipment = std::make_shared<Equipment>(*robot.equipment);
  equipment->bumpers = {"camera_depth_optical_frame"};  // it faces ahead and to the right
  robot.equipment = equipment;
  const KnownMap map = flat.map();
  Navigator navigator(map, robot, {box_at(5.0, 0.6)});
  Driven driven(flat, robot, {{1, 1}, 2.0});
  double back = 0;
  driven.wheels = [&](Twist2d& command) {
    EXPECT_EQ(command.y(), 0);
    back = std::min(back, command.x());
  };
  driven.bumper = [](double t) { return t > 0.5 && t < 0.7; };
  driven.run(navigator, 5);
  EXPECT_LT(back, -0.05);
}

TEST(Navigator, ARobotWithoutLasersOrWheelsIsRefused) {
  const Flat flat;
  const KnownMap map = flat.map();
  Robot robot = test::pepper();
  auto equipment = std::make_shared<Equipment>(*robot.equipment);
  equipment->wheels.reset();
  robot.equipment = equipment;
  EXPECT_THROW(Navigator(map, robot, {box_at(5, 1)}), InputError);
  equipment = std::make_shared<Equipment>(*test::pepper().equipment);
  equipment->lasers.clear();
  robot.equipment = equipment;
  EXPECT_THROW(Navigator(map, robot, {box_at(5, 1)}), InputError);
  robot.equipment = nullptr;
  try {
    Navigator(map, robot, {box_at(5, 1)});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("has no lasers"), std::string::npos);
  }
}

TEST(Navigator, StuckItSaysSoAndStops) {
  const Flat flat;
  const Robot robot = test::pepper();
  const KnownMap map = flat.map();
  Navigator navigator(map, robot, {box_at(5.0, 0.6)});
  Driven driven(flat, robot, {{1, 1}, 2.0});
  driven.wheels = [](Twist2d& command) {
    command.head<2>().setZero();
  };  // the wheels only turn the robot
  driven.run(navigator, 400);
  EXPECT_EQ(navigator.state(), NavigatorState::kStuck) << driven.said;
  EXPECT_NE(driven.said.find("it is stuck and stops"), std::string::npos);
}

TEST(Navigator, ItGivesUpWhereNoWayLeads) {
  Flat flat;
  for (int y = 0; y < 80; ++y) flat.solid(60, y) = 1;  // the gap is closed
  const Robot robot = test::pepper();
  const KnownMap map = flat.map();
  Navigator navigator(map, robot, {box_at(5.0, 0.6)});
  Driven driven(flat, robot, {{1, 1}, 2.0});
  driven.run(navigator, 200);
  EXPECT_EQ(navigator.state(), NavigatorState::kNoPath) << driven.said;
}

TEST(Navigator, WhereNoWayLeadsToTheFirstItDrivesToTheNext) {
  Flat flat;
  for (int y = 0; y < 80; ++y) flat.solid(60, y) = 1;  // the gap is closed
  const Robot robot = test::pepper();
  const KnownMap map = flat.map();
  NavigatorGoal behind = box_at(5.0, 0.6), near = box_at(0.7, 3.4);
  near.name = "box 2";
  Navigator navigator(map, robot, {box_at(9.0, 1.0), behind, near});
  Driven driven(flat, robot, {{1, 1}, 2.0});
  driven.run(navigator, 120);
  EXPECT_EQ(navigator.state(), NavigatorState::kArrived) << driven.said;
  EXPECT_NE(driven.said.find("has arrived at box 2"), std::string::npos) << driven.said;
  EXPECT_LT((driven.at().place_m - Vector2d(0.7, 3.4)).norm(), 0.9 + 0.2);
}

TEST(Navigator, AWayThatItSeesShutDoesNotCount) {
  Flat flat;
  const Robot robot = test::pepper();
  const KnownMap map = flat.map();  // the gap is open in the map
  for (int y = 0; y < 80; ++y) flat.solid(60, y) = 1;
  NavigatorGoal near = box_at(0.7, 3.4);
  near.name = "box 2";
  Navigator navigator(map, robot, {box_at(5.0, 0.6), near});
  Driven driven(flat, robot, {{1, 1}, 2.0});
  driven.run(navigator, 200);
  EXPECT_EQ(navigator.state(), NavigatorState::kArrived) << driven.said;
  EXPECT_NE(driven.said.find("has arrived at box 2"), std::string::npos) << driven.said;
  EXPECT_GT(driven.nearest_m, 0.27);
}

TEST(Navigator, WhatItCannotGetToComesLast) {
  const Flat flat;
  const Robot robot = test::pepper();
  const KnownMap map = flat.map();
  NavigatorGoal near = box_at(0.7, 3.4);
  near.name = "box 2";
  Navigator navigator(map, robot, {box_at(5.0, 0.6), near});
  Driven driven(flat, robot, {{1, 1}, 2.0});
  driven.wheels = [&](Twist2d& command) {  // an obstacle that no sensor sees holds the robot
    if ((driven.at() * Vector2d(0.1 * command.head<2>())).x() > 1.5) command.head<2>().setZero();
  };
  driven.run(navigator, 200);
  EXPECT_EQ(navigator.state(), NavigatorState::kArrived) << driven.said;
  EXPECT_NE(driven.said.find("drives to box 1"), std::string::npos) << driven.said;
  EXPECT_NE(driven.said.find("has arrived at box 2"), std::string::npos) << driven.said;
}

TEST(Navigator, ABumperStopsItAndManyEndTheDrive) {
  const Flat flat;
  const Robot robot = test::pepper();
  const KnownMap map = flat.map();
  Navigator once(map, robot, {box_at(5.0, 0.6)});
  Driven driven(flat, robot, {{1, 1}, 0});
  driven.bumper = [](double t) { return t > 3 && t < 3.1; };
  driven.run(once, 120);
  EXPECT_EQ(once.state(), NavigatorState::kArrived) << driven.said;
  EXPECT_NE(driven.said.find("bump 1"), std::string::npos);
  Navigator always(map, robot, {box_at(5.0, 0.6)});
  Driven pressed(flat, robot, {{1, 1}, 0});
  pressed.bumper = [](double) { return true; };
  pressed.run(always, 120);
  EXPECT_EQ(always.state(), NavigatorState::kCollided) << pressed.said;
}

}  // namespace
}  // namespace mh
