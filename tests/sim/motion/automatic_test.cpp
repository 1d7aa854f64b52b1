// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/automatic.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "scenes/generate/generate.hpp"
#include "scenes/house/house.hpp"
#include "sim/motion/replay.hpp"
#include "slam/io/error.hpp"
#include "source_dir.hpp"
#include "tests/sim/boxes.hpp"
#include "tests/sim/motion/limits_kept.hpp"

namespace mh {
namespace {

using test::add_box;
using test::empty_room;
using test::pepper;

Tour tour_to(const Eigen::Vector2d& start, const Eigen::Vector2d& goal) {
  Tour tour;
  tour.name = "test";
  tour.file = "test.yaml";
  tour.start_m = start;
  tour.waypoints.push_back({.position_m = goal});
  return tour;
}

/// The rooms that a path passes through; all rooms are rectangles.
std::set<std::string> rooms_of(const DrivenPath& path, const Scene& scene) {
  std::set<std::string> rooms;
  for (const TimedPose& pose : path.base)
    for (const Room& room : scene.rooms) {
      const Eigen::Vector2d p = pose.world_from_camera.translation().head<2>();
      if (((p - room.polygon_m[0]).array() > 0).all() &&
          ((room.polygon_m[2] - p).array() > 0).all())
        rooms.insert(room.name);
    }
  return rooms;
}

TEST(AutomaticTour, LeadsThroughTheWholeHouseWithoutTouchingAnything) {
  const Scene house = load_house(MH_SOURCE_DIR "/scenes/model_house/house.yaml");
  const Tour tour = automatic_tour(house, pepper());
  const DrivenPath path = drive(house, pepper(), tour);
  EXPECT_LT(path.contact_time_s, 0.1);
  EXPECT_LT(path.max_penetration_m, 1e-3);
  EXPECT_GT(path.length_m, 20.0);
  test::expect_limits_kept(path.peaks, pepper().limits);
  EXPECT_LT(
      angle_between_rad(path.base.front().world_from_camera, path.base.back().world_from_camera),
      0.05);
  EXPECT_EQ(rooms_of(path, house).size(), house.rooms.size());
}

TEST(AutomaticTour, LeadsIntoEveryRoomOfAGeneratedFloor) {
  for (const char* floor : {"hotel", "office_floor"})
    for (std::uint64_t seed : {0, 1}) {
      const Scene scene = generate_scene({floor, seed});
      const DrivenPath path = drive(scene, pepper(), automatic_tour(scene, pepper()));
      EXPECT_LT(path.contact_time_s, 0.1) << floor << seed;
      EXPECT_EQ(rooms_of(path, scene).size(), scene.rooms.size()) << floor << seed;
    }
}

TEST(AutomaticTour, OtherSeedsGoElsewhereInEveryRoom) {
  for (const char* place : {"office", "lobby"}) {
    const Scene scene = load_house(std::string(MH_SOURCE_DIR "/scenes/rooms/") + place + ".yaml");
    const Tour a = automatic_tour(scene, pepper()),
               b = automatic_tour(scene, pepper(), {.seed = 1});
    EXPECT_GT((a.start_m - b.start_m).norm(), 0.1) << place;
    for (const Tour* tour : {&a, &b}) {
      const DrivenPath path = drive(scene, pepper(), *tour);
      EXPECT_LT(path.contact_time_s, 0.1) << place;
      EXPECT_GT(path.camera.size(), 300U) << place;
      test::expect_limits_kept(path.peaks, pepper().limits);
    }
  }
}

TEST(AutomaticTour, ASurveyLooksAroundAtEachOfItsPlaces) {
  const Scene scene = load_house(MH_SOURCE_DIR "/scenes/rooms/office.yaml");
  const Tour brief = automatic_tour(scene, pepper()),
             survey = automatic_tour(scene, pepper(), {.survey = true});
  ASSERT_EQ(survey.waypoints.size(), brief.waypoints.size());
  const auto turns = [](const Tour& tour) {
    return std::ranges::count_if(tour.waypoints,
                                 [](const Waypoint& w) { return w.turn_rad == 2 * M_PI; });
  };
  EXPECT_EQ(turns(brief), 1);
  EXPECT_GT(turns(survey), 2);
  const auto turned = [](const DrivenPath& path) {
    double sum_rad = 0;
    for (std::size_t i = 1; i < path.base.size(); ++i)
      sum_rad +=
          angle_between_rad(path.base[i - 1].world_from_camera, path.base[i].world_from_camera);
    return sum_rad;
  };
  const DrivenPath path = drive(scene, pepper(), survey);
  EXPECT_LT(path.contact_time_s, 0.1);
  EXPECT_GT(turned(path), turned(drive(scene, pepper(), brief)) +
                              0.9 * 2 * M_PI * static_cast<double>(turns(survey) - 1));
}

TEST(Planned, GoesRoundWhatStandsInTheWay) {
  Scene scene = empty_room();
  add_box(scene, "sofa", {5, 0, 0}, {6, 8, 0.8F});
  Tour tour = tour_to({3, 2}, {8, 2});
  EXPECT_THROW(drive(scene, pepper(), tour), InputError);  // the straight path gets stuck
  tour.plan = true;
  const DrivenPath path = drive(scene, pepper(), tour);
  EXPECT_EQ(path.contact_time_s, 0.0);
  EXPECT_LT((path.base.back().world_from_camera.translation() - Eigen::Vector3d(8, 2, 0)).norm(),
            0.02);
}

TEST(Planned, AWaypointThatCannotBeReachedIsNamed) {
  Scene scene = empty_room();
  add_box(scene, "sofa", {5, 0, 0}, {6, 10, 0.8F});
  const auto refusal = [&](const Eigen::Vector2d& goal) -> std::string {
    Tour tour = tour_to({3, 2}, goal);
    tour.waypoints[0].line = 7;
    try {
      planned(scene, pepper(), tour);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_NE(
      refusal({8, 2}).find(
          "test.yaml:7: waypoint 1: [8.00, 2.00] cannot be reached: no path from [3.00, 2.00]"),
      std::string::npos)
      << refusal({8, 2});
  EXPECT_NE(refusal({5.1, 2}).find("cannot be reached against sofa"), std::string::npos);
}

TEST(Replay, KeepsTheShapeOfTheRecordingAndStaysClear) {
  // A wavy walk of 4 m at 100 Hz, rotated and far from the room.
  Trajectory recorded;
  for (int i = 0; i <= 800; ++i) {
    const double t = 0.01 * i;
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.3 * t, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    recorded.push_back({1'000'000'000'000 + i * 10'000'000LL,
                        SE3(turn, {100 + 0.5 * t, -50 + 0.2 * std::sin(t), 1.2})});
  }
  Scene scene = empty_room();
  add_box(scene, "table", {3, 3, 0}, {7, 7, 0.75F});    // below the camera
  add_box(scene, "cupboard", {4, 8, 0}, {7, 9, 2.0F});  // not below the camera
  const Robot robot = pepper();
  const DrivenPath path = replay(scene, robot.camera, recorded, "walk.tum");
  ASSERT_EQ(path.camera.size(), 241U);
  for (std::size_t i = 0; i < path.camera.size(); ++i) {
    const Eigen::Vector3d p = path.camera[i].world_from_camera.translation();
    EXPECT_TRUE(p.x() > 0.1 && p.x() < 9.9 && p.y() > 0.1 && p.y() < 9.9) << p.transpose();
    EXPECT_NEAR(p.z(), 1.2, 1e-12);
    // Distance from the start and rotation since the start are those of the recording.
    const double t = static_cast<double>(i) / 30;
    EXPECT_NEAR((p - path.camera[0].world_from_camera.translation()).norm(),
                std::hypot(0.5 * t, 0.2 * std::sin(t)), 1e-4);
    EXPECT_NEAR(
        angle_between_rad(path.camera[0].world_from_camera, path.camera[i].world_from_camera),
        std::abs(std::remainder(0.3 * t, 2 * M_PI)), 1e-6);
  }
  EXPECT_THROW(replay(scene, robot.camera, {recorded.front()}, "short.tum"), InputError);
  EXPECT_THROW(
      replay(scene, robot.camera, recorded, "walk.tum", {.at = Eigen::Vector3d(5, 7.8, 0)}),
      InputError);
  for (TimedPose& pose : recorded)
    pose.world_from_camera =
        SE3(pose.world_from_camera.rotation(),
            10 * pose.world_from_camera.translation() - Eigen::Vector3d(0, 0, 9 * 1.2));
  EXPECT_THROW(replay(scene, robot.camera, recorded, "far.tum"), InputError);  // 40 m does not fit
}

}  // namespace
}  // namespace mh
