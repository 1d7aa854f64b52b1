// SPDX-License-Identifier: Apache-2.0
// Tours and scripts for a robot that cannot move sideways.
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "robots/model/odometry.hpp"
#include "sim/motion/automatic.hpp"
#include "sim/motion/commands.hpp"
#include "sim/motion/path.hpp"
#include "sim/motion/reference.hpp"
#include "sim/motion/sensing.hpp"
#include "slam/io/error.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using test::add_box;
using test::empty_room;
using test::turtlebot;

/// The TurtleBot with its axle at a different place on its base.
Robot turtlebot_with_axle_at(double x) {
  Robot robot = turtlebot();
  auto equipment = std::make_shared<Equipment>(*robot.equipment);
  for (WheelBase::Wheel& wheel : equipment->wheels->wheels) wheel.place_m.x() = x;
  EXPECT_EQ(find_kind(*equipment->wheels), "");
  robot.equipment = equipment;
  return robot;
}

Tour tour_of(std::initializer_list<Vector2d> places) {
  Tour tour;
  tour.name = "test";
  tour.start_m = *places.begin();
  for (auto place = places.begin() + 1; place != places.end(); ++place)
    tour.waypoints.push_back({.position_m = *place});
  return tour;
}

struct Sideways {
  double middle_m_per_s = 0;  ///< maximum lateral speed of the point midway between the wheels
  double turned_rad = 0;      ///< total angle
};

/// Treats the motion between neighboring poses as a constant twist.
Sideways sideways(const Trajectory& base, const WheelBase& wheels) {
  Sideways most;
  for (std::size_t i = 1; i < base.size(); ++i) {
    const double s = 1e-9 * static_cast<double>(base[i].stamp_ns - base[i - 1].stamp_ns);
    const Vector6d v =
        (base[i - 1].world_from_camera.inverse() * base[i].world_from_camera).log() / s;
    most.middle_m_per_s =
        std::max(most.middle_m_per_s, std::abs(v[1] + v[5] * wheels.middle_m.x()));
    most.turned_rad += std::abs(v[5]) * s;
  }
  return most;
}

// Between frames, a constant twist ignores the changes of turn rate and speed: (v alpha + a omega)
// t^2 / 12, which at the TurtleBot's limits is (0.26 x 3.2 + 2.5 x 1.82) / (900 x 12) = 0.5 mm/s. A
// wheel base that is off by 1 cm slides at 18 mm/s.
constexpr double kNotSideways_m_per_s = 6e-4;

TEST(DifferentialMotion, FacesItsWayAndKeepsEveryLimit) {
  for (const double axle_x : {0.0, -0.12})
    for (const bool jerk : {false, true}) {
      Robot robot = turtlebot_with_axle_at(axle_x);
      if (jerk) {
        robot.limits.max_jerk_m_per_s3 = 5.0;
        robot.limits.max_turn_jerk_rad_per_s3 = 10.0;
      }
      const WheelBase& wheels = *robot.differential();
      Tour tour = tour_of({{0, 0}, {2, 0}, {2, 2}, {1.5, 2.2}, {1, 1}, {0, 1}});
      tour.waypoints[1].look_at_m = Vector2d(9, 9);  // impossible for this robot
      tour.waypoints[3].heading_rad = 2.0;           // it turns to this at a stop
      tour.waypoints.back().turn_rad = -4;
      tour.waypoints.back().pause_s = 0.5;
      constexpr double h = 1.0 / 240;
      Vector2d middle_before = Vector2d::Zero(), v_before = middle_before;
      double heading_before = 0, w_before = 0, top = 0, top_turn = 0;
      bool first = true, turned_to_two = false;
      for (const Stretch& stretch : reference_motion(tour, robot.limits, h, &wheels)) {
        Vector2d base_before = stretch.position_m.front();
        for (std::size_t i = 0; i < stretch.position_m.size(); ++i) {
          const double heading = stretch.heading_rad[i];
          const Vector2d middle =
              stretch.position_m[i] + Eigen::Rotation2Dd(heading) * wheels.middle_m;
          turned_to_two = turned_to_two || std::abs(heading - 2.0) < 1e-9;
          if (!first) {
            const double turned = heading - heading_before;
            const Vector2d ahead(std::cos(heading_before + 0.5 * turned),
                                 std::sin(heading_before + 0.5 * turned));
            const Vector2d moved = middle - middle_before;
            ASSERT_NEAR(ahead.x() * moved.y() - ahead.y() * moved.x(), 0, 1e-7) << i;
            const Vector2d v = (stretch.position_m[i] - base_before) / h;
            const double w = turned / h;
            ASSERT_LE(v.norm(), robot.limits.max_velocity_m_per_s);
            ASSERT_LE(std::abs(w), robot.limits.max_turn_rad_per_s);
            ASSERT_LE((v - v_before).norm() / h, robot.limits.max_acceleration_m_per_s2 * 1.001);
            ASSERT_LE(std::abs(w - w_before) / h,
                      robot.limits.max_turn_acceleration_rad_per_s2 * 1.001);
            ASSERT_LE(rim_speeds_m_per_s(wheels, twist_of(wheels, ahead.dot(moved) / h, w))
                          .cwiseAbs()
                          .maxCoeff(),
                      wheels.max_rim_m_per_s);
            top = std::max(top, v.norm());
            top_turn = std::max(top_turn, std::abs(w));
            v_before = v;
            w_before = w;
          }
          first = false;
          middle_before = middle;
          base_before = stretch.position_m[i];
          heading_before = heading;
        }
      }
      EXPECT_TRUE(turned_to_two);
      EXPECT_GT(top, axle_x == 0 ? 0.95 * robot.limits.max_velocity_m_per_s : 0.1);
      EXPECT_GT(top_turn, 0.5 * robot.limits.max_turn_rad_per_s);
      EXPECT_LT((middle_before - Vector2d(0, 1)).norm(), 1e-9);
    }
}

TEST(RoundedPath, EasedBendsAreSmoothAndStayBetweenTheCornerAndItsArc) {
  const std::vector<Vector2d> corners{{0, 0}, {2, 0}, {2, 2}, {0.5, 1}};
  const RoundedPath arcs(corners), eased(corners, {.eased = true});
  const auto to_corner = [&](const RoundedPath& path) {
    double nearest = 1e9;
    for (double s = 0; s < path.length_m(); s += 1e-3)
      nearest = std::min(nearest, (path.at(s).position_m - corners[1]).norm());
    return nearest;
  };
  EXPECT_GT(to_corner(eased), 0.5 * to_corner(arcs));
  EXPECT_LT(to_corner(eased), to_corner(arcs));
  EXPECT_GT(eased.length_m(), arcs.length_m());
  EXPECT_LT(eased.length_m(), 4 + (corners[3] - corners[2]).norm());
  EXPECT_LT((eased.at(eased.length_m()).position_m - corners.back()).norm(), 1e-12);
  // The direction is the derivative of the position, and the curvature is that of the direction's
  // angle.
  constexpr double d = 1e-5;
  for (double s = 0.01; s < eased.length_m() - 0.01; s += 0.013) {
    const PathPoint before = eased.at(s - d), here = eased.at(s), after = eased.at(s + d);
    EXPECT_LT(((after.position_m - before.position_m) / (2 * d) - here.direction).norm(), 1e-5);
    const double turned = std::asin(before.direction.x() * after.direction.y() -
                                    before.direction.y() * after.direction.x());
    EXPECT_NEAR(turned / (2 * d), here.curvature_per_m, 1e-3);
    const RoundedPath::Bend most = eased.bend_at(s);
    EXPECT_LE(std::abs(here.curvature_per_m), most.curvature_per_m + 1e-12);
    EXPECT_LE(std::abs(after.curvature_per_m - before.curvature_per_m) / (2 * d),
              most.change_per_m2 + 1e-2);
  }
}

TEST(Drive, ATwoWheeledRobotFollowsItsTourWithoutMovingSideways) {
  for (const double axle_x : {0.0, 0.05}) {
    const Robot robot = turtlebot_with_axle_at(axle_x);
    const WheelBase& wheels = *robot.differential();
    Tour tour = tour_of({{2, 2}, {5, 2}, {5, 5}, {3, 4.5}, {2, 2}});
    tour.start_heading_rad = 1.0;
    tour.waypoints.back().heading_rad = 1.0;
    const DrivenPath path = drive(empty_room(), robot, tour);
    const Sideways moved = sideways(path.base, wheels);
    EXPECT_LT(moved.middle_m_per_s, kNotSideways_m_per_s);
    EXPECT_GT(moved.turned_rad, 2 * M_PI);
    EXPECT_LE(path.peaks.rim_m_per_s, wheels.max_rim_m_per_s);
    EXPECT_GT(path.peaks.rim_m_per_s, 0.9 * wheels.max_rim_m_per_s);
    // Within 5 mm of the planned path, which is checked against the corners above.
    const std::vector<Vector2d> corners{
        tour.start_m + Eigen::Rotation2Dd(1.0) * wheels.middle_m, {5, 2}, {5, 5}, {3, 4.5}, {2, 2}};
    const RoundedPath planned(corners, {.eased = true});
    double farthest = 0;
    for (const TimedPose& pose : path.base) {
      const Vector2d middle =
          (pose.world_from_camera * Eigen::Vector3d(wheels.middle_m.x(), 0, 0)).head<2>();
      double nearest = 1e9;
      for (double s = 0; s <= planned.length_m(); s += 0.002)
        nearest = std::min(nearest, (planned.at(s).position_m - middle).norm());
      farthest = std::max(farthest, nearest);
    }
    EXPECT_LT(farthest, 5e-3);
    const SE3& end = path.base.back().world_from_camera;
    EXPECT_LT(
        ((end * Eigen::Vector3d(wheels.middle_m.x(), 0, 0)).head<2>() - Vector2d(2, 2)).norm(),
        0.01);
    EXPECT_NEAR(std::atan2(end.rotation()(1, 0), end.rotation()(0, 0)), 1.0, 0.01);
  }
}

TEST(Drive, AnAutomaticTourOfATwoWheeledRobotTouchesNothing) {
  Scene scene = empty_room();
  add_box(scene, "shelf", {3, 0, 0}, {3.4F, 6, 1});
  add_box(scene, "table", {6, 4, 0}, {8, 5, 0.8F});
  const Robot robot = turtlebot();
  const DrivenPath path = drive(scene, robot, automatic_tour(scene, robot, {.seed = 2}));
  EXPECT_GT(path.length_m, 20);
  EXPECT_EQ(path.contact_time_s, 0);
  EXPECT_LT(sideways(path.base, *robot.differential()).middle_m_per_s, kNotSideways_m_per_s);
}

TEST(Drive, ATwoWheeledRobotThatIsPushedAsideSteersBack) {
  const Robot robot = turtlebot();
  MovingObstacle pedestrian{.instance = 90, .path = [](double t) {
                              // The pedestrian comes from the side as the robot passes, pushes it
                              // by a few cm, and leaves.
                              const double y = 4.2 + std::clamp(0.3 * (t - 6.7), 0.0, 0.4) -
                                               std::max(0.0, 0.3 * (t - 8.2));
                              return Vector2d(3.9, y);
                            }};
  pedestrian.radius_m = 0.22;
  const DrivenPath path = drive(empty_room(), robot, tour_of({{2, 5}, {8, 5}}), {pedestrian});
  EXPECT_GT(path.contact_time_s, 0.1);
  double pushed = 0, late = 0;
  for (const TimedPose& pose : path.base) {
    const Eigen::Vector3d at = pose.world_from_camera.translation();
    pushed = std::max(pushed, std::abs(at.y() - 5));
    if (at.x() > 7) late = std::max(late, std::abs(at.y() - 5));
  }
  EXPECT_GT(pushed, 0.015);
  EXPECT_LT(late, 0.005);
}

CommandScript script_of(std::vector<VelocityCommand> commands) {
  CommandScript script;
  script.file = "test.yaml";
  script.start_m = {5, 5};
  script.commands = std::move(commands);
  return script;
}

std::string refusal(const Robot& robot, const CommandScript& script) {
  try {
    drive(empty_room(), robot, script);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Commands, WhatTheRobotLacksIsToldWithFileAndLine) {
  Robot robot = turtlebot();
  EXPECT_EQ(refusal(robot, script_of({{.duration_s = 1, .left_m_per_s = 0.2, .line = 7}})),
            "test.yaml:7: robot 'turtlebot3' has a differential drive: it cannot go sideways "
            "(left_m_per_s: 0.2)");
  EXPECT_EQ(refusal(robot, script_of({{.duration_s = 1, .head_yaw_rad = 0.2, .line = 8}})),
            "test.yaml:8: robot 'turtlebot3' has no head to move (its file: equipment.head)");
  CommandScript script = script_of({{.duration_s = 1, .forward_m_per_s = 0.2}});
  EXPECT_EQ(refusal(robot, script), "no error");  // it has neither reflex nor jerk limits
  script.reflex = true;
  EXPECT_EQ(refusal(robot, script),
            "test.yaml: robot 'turtlebot3' has no reflex to enable (its file: "
            "equipment.collision_reflex)");
  // A robot without wheels, or without equipment, can move in any direction.
  auto equipment = std::make_shared<Equipment>(*robot.equipment);
  equipment->wheels.reset();
  robot.equipment = equipment;
  script = script_of({{.duration_s = 3, .left_m_per_s = 0.2}});
  for (int i = 0; i < 2; ++i) {
    const Trajectory base = drive(empty_room(), robot, script).path.base;
    EXPECT_GT(base.back().world_from_camera.translation().y(), 5.5);
    robot.equipment = nullptr;
  }
}

TEST(Commands, ATwoWheeledRobotObeysWithoutMovingSideways) {
  for (const double axle_x : {0.0, -0.1}) {
    const Robot robot = turtlebot_with_axle_at(axle_x);
    const WheelBase& wheels = *robot.differential();
    const CommandScript script =
        script_of({{.duration_s = 3, .forward_m_per_s = 0.2},
                   {.duration_s = 4, .forward_m_per_s = 0.2, .turn_rad_per_s = 0.4},
                   {.duration_s = 4, .forward_m_per_s = 0.5, .turn_rad_per_s = -3},
                   {.duration_s = 3, .forward_m_per_s = -0.1, .turn_rad_per_s = 1},
                   {.duration_s = 2, .turn_rad_per_s = -1}});
    const DrivenPath path = drive(empty_room(), robot, script).path;
    EXPECT_LT(sideways(path.base, wheels).middle_m_per_s, kNotSideways_m_per_s);
    EXPECT_LE(path.peaks.rim_m_per_s, wheels.max_rim_m_per_s);
    EXPECT_GT(path.peaks.rim_m_per_s, 0.9 * wheels.max_rim_m_per_s);
    // After the first command, the robot has driven straight ahead by v t - v^2 / (2 a).
    EXPECT_NEAR(path.base[90].world_from_camera.translation().x(), 5.6 - 0.008, 2e-3);
    // The odometry from its encoders gives its true position.
    const Trajectory odometry = read_sensors(empty_room(), robot, path.base, 0).odometry;
    ASSERT_EQ(odometry.size(), path.base.size());
    const Trajectory exact = wheel_odometry(path.base, wheels, {}, 0);
    EXPECT_LT((exact.back().world_from_camera.translation() -
               path.base.back().world_from_camera.translation())
                  .norm(),
              1e-3);
  }
}

TEST(Sensing, WithoutWheelsAndImuThereIsNeitherOdometryNorForce) {
  Robot robot = turtlebot();
  auto equipment = std::make_shared<Equipment>(*robot.equipment);
  equipment->wheels.reset();
  equipment->base_from_imu.reset();
  robot.equipment = equipment;
  const Trajectory base{{0, SE3(Eigen::Matrix3d::Identity(), {5, 5, 0})}};
  const RobotReadings readings = read_sensors(empty_room(), robot, base, 0);
  EXPECT_TRUE(readings.odometry.empty());
  ASSERT_EQ(readings.moments.size(), 1U);
  EXPECT_EQ(readings.moments[0].specific_force_m_per_s2.norm(), 0);
  EXPECT_EQ(readings.moments[0].lasers_m[0].size(), 360U);
}

}  // namespace
}  // namespace mh
