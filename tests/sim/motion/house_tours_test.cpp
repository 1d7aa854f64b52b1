// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "scenes/house/house.hpp"
#include "sim/motion/motion.hpp"
#include "slam/io/error.hpp"
#include "source_dir.hpp"
#include "tests/sim/boxes.hpp"
#include "tests/sim/motion/nearest_view.hpp"

namespace mh {
namespace {

const std::string kHouse = MH_SOURCE_DIR "/scenes/model_house/";

const Scene& house() {
  static const Scene scene = load_house(kHouse + "house.yaml");
  return scene;
}

DrivenPath driven(const std::string& tour) {
  return drive(house(), test::pepper(), load_tour(kHouse + "tours/" + tour + ".yaml"));
}

/// The name of the room at a point; all rooms of the model house are rectangles.
std::string room_at(const Eigen::Vector3d& p) {
  for (const Room& room : house().rooms) {
    Eigen::Vector2d low = room.polygon_m.front(), high = low;
    for (const Eigen::Vector2d& corner : room.polygon_m) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    if ((p.head<2>() - low).minCoeff() > 0 && (high - p.head<2>()).minCoeff() > 0) return room.name;
  }
  return "doorway";
}

/// For each room, the number of frames that look into each quarter (east, north, west, south).
std::map<std::string, std::array<int, 4>> views(const DrivenPath& path) {
  std::map<std::string, std::array<int, 4>> result;
  for (const TimedPose& pose : path.camera) {
    const Eigen::Vector3d ahead = pose.world_from_camera.rotation().col(2);
    const double quarter = std::atan2(ahead.y(), ahead.x()) / M_PI_2;
    ++result[room_at(pose.world_from_camera.translation())][std::lround(quarter + 4) % 4];
  }
  return result;
}

void expect_free_run(const DrivenPath& path) {
  EXPECT_LT(path.contact_time_s, 0.1);
  EXPECT_LT(path.max_penetration_m, 1e-3);
}

TEST(HouseTours, MappingLeadsThroughAllRoomsAndBack) {
  const DrivenPath path = driven("mapping");
  expect_free_run(path);
  EXPECT_GE(path.length_m, 60.0);
  EXPECT_LE(path.length_m, 70.0);
  EXPECT_LE(path.camera.size(), 4500U);
  EXPECT_GE(path.turned_in_place_rad, 4 * M_PI);
  // The tour ends where it began, facing the same direction.
  const SE3& first = path.base.front().world_from_camera;
  const SE3& last = path.base.back().world_from_camera;
  EXPECT_LT((last.translation() - first.translation()).norm(), 0.02);
  EXPECT_LT(angle_between_rad(first, last), 0.02);
  // At least one second of frames faces each quarter of each room.
  const auto seen = views(path);
  ASSERT_EQ(house().rooms.size(), 4U);
  for (const Room& room : house().rooms) {
    ASSERT_TRUE(seen.contains(room.name)) << room.name;
    for (const int frames : seen.at(room.name)) EXPECT_GT(frames, 30) << room.name;
  }
}

TEST(HouseTours, QueriesComeFromElsewhereInAllRooms) {
  const DrivenPath mapping = driven("mapping"), query = driven("query");
  expect_free_run(query);
  EXPECT_GE(query.length_m, 25.0);
  EXPECT_LE(query.length_m, 35.0);
  const auto seen = views(query);
  for (const Room& room : house().rooms) EXPECT_TRUE(seen.contains(room.name)) << room.name;

  // The query tour does not repeat the mapping tour.
  EXPECT_GT(test::median_distance_to_nearest_view(query.camera, mapping.camera), 0.15);
}

TEST(HouseTours, AWaypointInsideTheSofaCannotBeReached) {
  Tour tour = load_tour(kHouse + "tours/mapping.yaml");
  Waypoint sofa;
  sofa.position_m = {0.5, 1.3};
  tour.waypoints = {sofa};
  try {
    drive(house(), test::pepper(), tour);
    FAIL() << "the robot drove into the sofa";
  } catch (const InputError& e) {
    const std::string message = e.what();
    EXPECT_NE(message.find("waypoint 1"), std::string::npos) << message;
    EXPECT_NE(message.find("sofa"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace mh
