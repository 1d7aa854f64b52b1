// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "sim/motion/motion.hpp"
#include "sim/motion/path.hpp"
#include "slam/io/error.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using test::add_box;
using test::empty_room;
using test::pepper;

double heading_rad(const SE3& world_from_base) {
  return std::atan2(world_from_base.rotation()(1, 0), world_from_base.rotation()(0, 0));
}

Tour tour_of(std::vector<Waypoint> waypoints) {
  return {.name = "test",
          .file = "test.yaml",
          .start_m = {2, 2},
          .start_heading_rad = 0.0,
          .max_velocity_m_per_s = {},
          .max_turn_rad_per_s = {},
          .waypoints = std::move(waypoints)};
}

Waypoint to(double x, double y) {
  Waypoint w;
  w.position_m = {x, y};
  return w;
}

Waypoint turn(Waypoint w, double turn_rad) {
  w.turn_rad = turn_rad;
  return w;
}

std::string refusal(const Scene& scene, const Tour& tour) {
  try {
    drive(scene, pepper(), tour);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Drive, AStraightLegIsAsLongAsItsEndsAreApart) {
  const DrivenPath path = drive(empty_room(), pepper(), tour_of({to(8, 2)}));
  EXPECT_NEAR(path.length_m, 6.0, 0.01);  // arrivals are within 1 cm
  EXPECT_EQ(path.contact_time_s, 0.0);
  EXPECT_EQ(path.max_penetration_m, 0.0);
  EXPECT_EQ(path.turned_in_place_rad, 0.0);
  EXPECT_NEAR(path.base.back().world_from_camera.translation().x(), 8.0, 0.01);
}

TEST(Drive, ARoundTripIsShorterThanItsCornersByTheLawOfBows) {
  const DrivenPath path = drive(empty_room(), pepper(), tour_of({to(8, 2), to(8, 8), to(2, 8)}));
  // Leaving a right-angled path at distance r before the corner and rejoining it r after the corner
  // saves (2 - pi / 2) r.
  EXPECT_NEAR(path.length_m, 18.0 - 2 * (2 - M_PI_2) * PathConfig{}.cut_m, 0.02);
}

TEST(Drive, FramesAreStampedAtTheCamerasRateAndCarryItsPose) {
  const Robot robot = pepper();
  const DrivenPath path = drive(empty_room(), robot, tour_of({to(4, 3), turn(to(4, 3), 2.0)}));
  ASSERT_EQ(path.camera.size(), path.base.size());
  ASSERT_GT(path.camera.size(), 60U);
  for (std::size_t i = 0; i < path.camera.size(); ++i) {
    ASSERT_EQ(path.camera[i].stamp_ns, std::llround(static_cast<double>(i) * 1e9 / 30.0));
    ASSERT_EQ(path.base[i].stamp_ns, path.camera[i].stamp_ns);
    const SE3 base_from_camera =
        path.base[i].world_from_camera.inverse() * path.camera[i].world_from_camera;
    ASSERT_LT((base_from_camera.inverse() * robot.base_from_camera).log().norm(), 1e-12);
    ASSERT_EQ(path.base[i].world_from_camera.translation().z(), 0.0);
  }
}

TEST(Drive, SampledMotionKeepsTheLimits) {
  const Robot robot = pepper();
  Tour tour = tour_of({to(8, 2), turn(to(8, 8), -4.0), to(3, 7), to(7, 4), to(2, 2)});
  const DrivenPath path = drive(empty_room(), robot, tour);
  const double dt = 1.0 / robot.camera.rate_hz;
  double top_speed = 0, top_turn = 0;
  Eigen::Vector3d v_before = Eigen::Vector3d::Zero();
  double w_before = 0;
  for (std::size_t i = 1; i < path.base.size(); ++i) {
    const SE3 &a = path.base[i - 1].world_from_camera, &b = path.base[i].world_from_camera;
    const Eigen::Vector3d v = (b.translation() - a.translation()) / dt;
    const double w = std::remainder(heading_rad(b) - heading_rad(a), 2 * M_PI) / dt;
    // Single-precision positions near 8 m are 1e-6 m apart: 3e-5 m/s, 1e-3 m/s^2.
    ASSERT_LE(v.norm(), robot.limits.max_velocity_m_per_s + 1e-4) << i;
    ASSERT_LE(std::abs(w), robot.limits.max_turn_rad_per_s + 1e-4) << i;
    ASSERT_LE((v - v_before).norm() / dt, robot.limits.max_acceleration_m_per_s2 + 5e-3) << i;
    ASSERT_LE(std::abs(w - w_before) / dt, robot.limits.max_turn_acceleration_rad_per_s2 + 5e-3)
        << i;
    top_speed = std::max(top_speed, v.norm());
    top_turn = std::max(top_turn, std::abs(w));
    v_before = v;
    w_before = w;
  }
  EXPECT_NEAR(top_speed, robot.limits.max_velocity_m_per_s, 0.01);
  EXPECT_NEAR(top_turn, robot.limits.max_turn_rad_per_s, 0.01);
}

TEST(Drive, ATourMayBeGentlerThanTheRobot) {
  Tour tour = tour_of({to(6, 2)});
  tour.max_velocity_m_per_s = 0.2;
  const DrivenPath path = drive(empty_room(), pepper(), tour);
  EXPECT_NEAR(path.base.back().stamp_ns * 1e-9, 4.0 / 0.2, 2.0);
}

TEST(Drive, TurnsInPlaceByWholeRounds) {
  const DrivenPath path = drive(empty_room(), pepper(), tour_of({turn(to(2, 2), 4 * M_PI)}));
  EXPECT_NEAR(path.turned_in_place_rad, 4 * M_PI, 0.02);
  EXPECT_LT(path.length_m, 1e-3);
  EXPECT_NEAR(heading_rad(path.base.back().world_from_camera), 0.0, 0.01);
}

TEST(Drive, FacesTravelAPlaceOrAHeading) {
  Waypoint looking = to(2, 8);
  looking.look_at_m = Eigen::Vector2d(9, 5);
  Waypoint headed = to(8, 2);
  headed.heading_rad = 2.0;
  const DrivenPath travel = drive(empty_room(), pepper(), tour_of({to(8, 8)}));
  EXPECT_NEAR(heading_rad(travel.base.back().world_from_camera), M_PI_4, 0.03);
  const DrivenPath at_place = drive(empty_room(), pepper(), tour_of({looking}));
  // At the end, the place to look at is seen from (2, 8); the heading may lag a little.
  EXPECT_NEAR(heading_rad(at_place.base.back().world_from_camera), std::atan2(-3, 7), 0.05);
  const DrivenPath at_heading = drive(empty_room(), pepper(), tour_of({headed}));
  EXPECT_NEAR(heading_rad(at_heading.base.back().world_from_camera), 2.0, 0.01);
  EXPECT_EQ(at_heading.contact_time_s, 0.0);
}

TEST(Drive, RepeatsBitForBit) {
  Scene scene = empty_room();
  add_box(scene, "stool", {4.5F, 2.3F, 0}, {5, 3, 0.5F});  // touched in passing
  const Tour tour = tour_of({to(8, 2.1), turn(to(8, 6), 3.0), to(3, 6)});
  const DrivenPath a = drive(scene, pepper(), tour), b = drive(scene, pepper(), tour);
  EXPECT_GT(a.contact_time_s, 0.1);
  EXPECT_LE(a.max_penetration_m, 5e-3);
  EXPECT_EQ(a.length_m, b.length_m);
  ASSERT_EQ(a.camera.size(), b.camera.size());
  for (std::size_t i = 0; i < a.camera.size(); ++i) {
    ASSERT_EQ(a.camera[i].world_from_camera.rotation(), b.camera[i].world_from_camera.rotation());
    ASSERT_EQ(a.camera[i].world_from_camera.translation(),
              b.camera[i].world_from_camera.translation());
  }
}

TEST(Drive, SaysWhereTheRobotIsStuckAndAgainstWhat) {
  Scene scene = empty_room();
  add_box(scene, "sofa", {5, 0, 0}, {6, 10, 0.8F});
  const std::string error = refusal(scene, tour_of({to(3, 2), to(8, 2)}));
  EXPECT_NE(error.find("test.yaml: waypoint 2: [8.00, 2.00] cannot be reached: the robot is stuck "
                       "at [4.74, 2.00] m against sofa"),
            std::string::npos)
      << error;
}

TEST(Drive, SaysThatAWaypointLiesOutsideTheRooms) {
  Tour tour = tour_of({to(3, 2), to(18, 2)});
  tour.waypoints[1].line = 9;
  for (const bool plan : {false, true}) {
    tour.plan = plan;
    const std::string error = refusal(empty_room(), tour);
    EXPECT_NE(error.find("test.yaml:9: waypoint 2: [18.00, 2.00] cannot be reached, since it is in "
                         "no room of empty room: "),
              std::string::npos)
        << error;
  }
}

TEST(Drive, WhoWalksIntoTheRobotPushesItAsideAndItFindsItsWayBack) {
  const auto comes_along = [](double y_m) {
    return MovingObstacle{.instance = 99, .path = [=](double time_s) {
                            return Eigen::Vector2d(8 - 0.5 * time_s, y_m);
                          }};
  };
  Tour tour = tour_of({to(8, 2)});
  const DrivenPath alone = drive(empty_room(), pepper(), tour);
  const DrivenPath missed = drive(empty_room(), pepper(), tour, {comes_along(2.5)});
  ASSERT_EQ(missed.base.size(), alone.base.size());
  for (std::size_t i = 0; i < alone.base.size(); ++i)
    ASSERT_EQ(missed.base[i].world_from_camera.translation(),
              alone.base[i].world_from_camera.translation());
  const DrivenPath touched = drive(empty_room(), pepper(), tour, {comes_along(2.475)});
  EXPECT_GT(touched.contact_time_s, 0);
  EXPECT_LE(touched.max_penetration_m, 5e-3);
  EXPECT_NEAR(touched.base.back().world_from_camera.translation().x(), 8, 0.01);
  // A person who stands in the path stops the tour, and the error says why.
  const MovingObstacle stands{.instance = 99, .path = [](double) { return Eigen::Vector2d(5, 2); }};
  try {
    drive(empty_room(), pepper(), tour, {stands});
    FAIL() << "the robot drove through a person";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("m against a pedestrian"), std::string::npos) << e.what();
  }
}

TEST(Drive, RefusesAStartInsideSomethingOrOutsideTheHouse) {
  Scene scene = empty_room();
  add_box(scene, "sofa", {2.1F, 1, 0}, {3, 3, 0.8F});
  Tour inside = tour_of({to(2, 5)});
  inside.start_line = 4;
  const std::string error = refusal(scene, inside);
  EXPECT_NE(error.find("test.yaml:4: start ["), std::string::npos) << error;
  EXPECT_NE(error.find("mm inside sofa"), std::string::npos) << error;
  Tour outside = tour_of({to(2, 5)});
  outside.start_m = {-3, 0};
  EXPECT_NE(refusal(empty_room(), outside).find("is in no room of empty room"), std::string::npos);
}

}  // namespace
}  // namespace mh
