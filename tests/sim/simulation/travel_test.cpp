// SPDX-License-Identifier: Apache-2.0
// Motions on floors that come from scanners and other programs.
#include "sim/simulation/travel.hpp"
#include "sim/motion/replay.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/temporary_folder.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "scenes/floor.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"
#include "tests/scenes/scanned_room.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using test::ScannedRoom;

Scene settled(Scene scene) {
  const auto found = find_floor(scene);
  scene.floor = found.value().floor;
  scene.rooms = {found->room};
  return scene;
}

double above(const Floor& floor, const Eigen::Vector3d& p) {
  return floor.up.dot(p - floor.middle_m);
}

class RealFloor : public ::testing::TestWithParam<std::pair<bool, double>> {
 protected:
  static Scene scene() {
    const auto [labeled, slope_deg] = GetParam();
    ScannedRoom room{.slope = {std::tan(slope_deg * std::numbers::pi / 180), 0},
                     .labeled = labeled};
    room.has_floor = [](double x, double y) { return std::hypot(x - 1, y - 1) > 0.08; };
    Scene scene = room.build();
    room.add_table(scene, 1.2, 0.8);
    return settled(std::move(scene));
  }
};
INSTANTIATE_TEST_SUITE_P(Floors, RealFloor,
                         ::testing::Values(std::pair(true, 0.0), std::pair(false, 0.0),
                                           std::pair(true, 1.5), std::pair(false, 1.5)));

TEST_P(RealFloor, RobotDrivesAlongIt) {
  const Scene room = scene();
  const Robot robot = test::pepper();
  const DrivenPath path = travel(room, robot, "auto:0");
  EXPECT_GT(path.length_m, 8.0);
  for (std::size_t i = 0; i < path.base.size(); ++i) {
    const SE3& base = path.base[i].world_from_camera;
    EXPECT_NEAR(above(room.floor, base.translation()), 0.0, 1e-9);
    EXPECT_LT((base.rotation().col(2) - room.floor.up).norm(), 1e-9);
    EXPECT_GT(above(room.floor, path.camera[i].world_from_camera.translation()), 1.0);
    // Around the table, not through it.
    EXPECT_FALSE(std::abs(base.translation().x()) < 0.6 && std::abs(base.translation().y()) < 0.4);
  }
}

TEST_P(RealFloor, PersonScansIt) {
  const Scene room = scene();
  const DrivenPath path = travel(room, test::pepper(), "handheld:0:90");
  ASSERT_EQ(path.camera.size(), 90U);
  for (const TimedPose& pose : path.camera)
    EXPECT_NEAR(above(room.floor, pose.world_from_camera.translation()), 1.4, 0.2);
  for (const TimedPose& pose : path.base)
    EXPECT_NEAR(above(room.floor, pose.world_from_camera.translation()), 0.0, 1e-9);
}

TEST(Travel, FloorThatLiesHigherLiftsThePathAndNothingElse) {
  const auto at = [](double z_m) {
    const ScannedRoom room{.floor_z_m = z_m, .noise_m = 0};
    Scene scene = room.build();
    room.add_table(scene, 1.25, 0.75);
    return settled(std::move(scene));
  };
  const Scene low = at(0), high = at(0.0625);  // exact in binary, like all heights
  ASSERT_EQ(high.floor.middle_m.z(), 0.0625);
  for (const char* motion : {"auto:1", "handheld:1:60"}) {
    const DrivenPath a = travel(low, test::pepper(), motion),
                     b = travel(high, test::pepper(), motion);
    ASSERT_EQ(a.camera.size(), b.camera.size());
    for (std::size_t i = 0; i < a.camera.size(); ++i) {
      const SE3 &p = a.camera[i].world_from_camera, &q = b.camera[i].world_from_camera;
      EXPECT_EQ(p.rotation(), q.rotation());
      EXPECT_EQ((p.translation() + Eigen::Vector3d(0, 0, 0.0625)).eval(), q.translation());
    }
  }
}

TEST(Travel, AHandheldScanMayStateItsFrames) {
  EXPECT_EQ(frames_stated("handheld:3:450"), 450u);
  EXPECT_EQ(frames_stated("generated:handheld:3:450"), 450u);
  for (const char* motion : {"handheld", "handheld:3", "auto:3", "replay:x.tum", "tour.yaml"})
    EXPECT_EQ(frames_stated(motion), std::nullopt) << motion;
}

TEST(Travel, AHurriedHandPassesTheSameWayInLessTime) {
  const Scene room = settled(ScannedRoom{}.build());
  const Robot robot = test::pepper();
  SensorConfig level = exact_sensors();
  const DrivenPath path = travel(room, robot, "handheld:0:90");
  const auto hurry = [&](const std::string& motion, double speed) {
    level.hurry = {.enabled = true, .speed = speed};
    return hurried(path, motion, level, robot.camera.rate_hz);
  };
  EXPECT_EQ(hurry("handheld:0:90", 1).camera.size(), path.camera.size());
  EXPECT_EQ(hurry("auto:0", 3).camera.size(), path.camera.size());
  const DrivenPath thrice = hurry("handheld:0:90", 3);
  ASSERT_EQ(thrice.camera.size(), 30U);
  ASSERT_EQ(thrice.base.size(), 30U);
  for (std::size_t i = 0; i < thrice.camera.size(); ++i) {
    const SE3 apart =
        thrice.camera[i].world_from_camera.inverse() * path.camera[3 * i].world_from_camera;
    EXPECT_LT(apart.log().norm(), 1e-6) << i;  // timestamps are whole nanoseconds
    EXPECT_EQ(thrice.camera[i].stamp_ns, path.camera[i].stamp_ns);
  }
  // At a speed of 1.5, 89 intervals of the path fit into 59 steps.
  EXPECT_EQ(hurry("handheld:0:90", 1.5).camera.size(), 60U);
}

TEST(Travel, PosesOfAFileStayWhereTheyAreAndAReplaySaysWhereItPutsThem) {
  const Scene room = settled(ScannedRoom{}.build());
  const Robot robot = test::pepper();
  const Trajectory scan = travel(room, robot, "handheld:0:30").camera;
  Trajectory elsewhere = scan;  // as if recorded in a different room
  for (TimedPose& pose : elsewhere)
    pose.world_from_camera = SE3(Eigen::Matrix3d::Identity(), {40, 0, 0}) * pose.world_from_camera;
  const TemporaryFolder folder(std::filesystem::temp_directory_path());
  const std::filesystem::path file = folder.path() / "poses.tum";
  write_tum(file, elsewhere);
  const DrivenPath replayed = travel(room, robot, "replay:" + file.string());
  EXPECT_NE(replayed.moved.find("its poses are moved"), std::string::npos) << replayed.moved;
  EXPECT_NE(replayed.moved.find("shifted by [-"), std::string::npos) << replayed.moved;
  EXPECT_EQ(travel(room, robot, "handheld:0:30").moved, "");

  const DrivenPath given = as_given(elsewhere, PosesOf::kCamera, robot.base_from_camera);
  EXPECT_EQ(given.moved, "");
  const DrivenPath driven = as_given(given.base, PosesOf::kRobot, robot.base_from_camera);
  ASSERT_EQ(given.camera.size(), elsewhere.size());
  for (std::size_t i = 0; i < elsewhere.size(); ++i) {
    EXPECT_EQ(given.camera[i].stamp_ns, elsewhere[i].stamp_ns);
    const SE3 &seen = given.camera[i].world_from_camera, &asked = elsewhere[i].world_from_camera;
    EXPECT_EQ(seen.translation(), asked.translation());
    EXPECT_EQ(seen.rotation(), asked.rotation());
    EXPECT_LT((driven.camera[i].world_from_camera.inverse() * elsewhere[i].world_from_camera)
                  .log()
                  .norm(),
              1e-12);
  }
}

TEST(NoteOn, APlaceToFaceIsNotForADifferentialDrive) {
  const TemporaryFolder folder(testing::TempDir());
  const std::string file = folder.path() / "tour.yaml";
  write_atomically(file,
                   "name: t\nstart: {position: [1, 1], heading_deg: 0}\nwaypoints:\n"
                   "- {to: [3, 1]}\n- {to: [3, 3], face: [9, 9]}\n");
  EXPECT_EQ(note_on(file, test::pepper()), "");
  EXPECT_EQ(note_on(file, test::turtlebot()),
            file +
                ":5: robot 'turtlebot3' has a differential drive: it faces its direction of "
                "travel, not the place in 'face'");
}

}  // namespace
}  // namespace mh
