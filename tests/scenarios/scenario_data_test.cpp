// SPDX-License-Identifier: Apache-2.0
// The scenarios as data: what their names promise holds, checked without running a system.
#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "bench/protocol/world/world.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/load.hpp"
#include "sim/simulation/pedestrian.hpp"
#include "sim/simulation/travel.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

const std::string kFolder = MH_SOURCE_DIR "/bench/scenarios/";

std::map<std::string, Eigen::Vector3f> places(const Scene& scene) {
  std::map<std::string, Eigen::Vector3f> result;
  for (const Instance& i : scene.instances) result[i.name] = 0.5F * (i.min_m + i.max_m);
  return result;
}

TEST(ScenarioData, TheSuiteHoldsEachNamedScenarioOverFiveSeeds) {
  const Suite suite = load_suite(MH_SOURCE_DIR "/bench/suites/ci.yaml");
  EXPECT_GE(suite.trials, 5);
  std::vector<std::string> names;
  for (const Environment& e : suite.environments) names.push_back(e.name);
  EXPECT_EQ(names, (std::vector<std::string>{"wooden_repetition", "blank_corridor", "fast_turn",
                                             "kidnapped_robot", "moved_furniture", "lights_changed",
                                             "label_noise", "long_loop", "walking_person"}));
}

TEST(ScenarioData, FurnitureMovesAndNothingElse) {
  const auto before = places(load_scene(kFolder + "room.yaml"));
  const auto after = places(load_scene(kFolder + "room_moved.yaml"));
  ASSERT_EQ(before.size(), after.size());
  std::vector<std::string> moved;
  for (const auto& [name, place] : before) {
    ASSERT_TRUE(after.contains(name)) << name;
    if ((after.at(name) - place).norm() > 0.2F) moved.push_back(name);
  }
  for (const char* name : {"living/sofa", "living/sideboard", "living/armchair", "living/plant",
                           "living/painting", "living/chair"})
    EXPECT_TRUE(std::ranges::find(moved, name) != moved.end()) << name;
  for (const char* name : {"living/bookshelf", "living/desk", "living/television", "living/rug"})
    EXPECT_TRUE(std::ranges::find(moved, name) == moved.end()) << name;
}

TEST(ScenarioData, InTheEveningTheLightIsAnotherAndNothingMoved) {
  const Scene day = load_scene(kFolder + "room.yaml");
  const Scene evening = load_scene(kFolder + "room_evening.yaml");
  EXPECT_EQ(day.positions_m, evening.positions_m);
  EXPECT_EQ(day.class_of, evening.class_of);
  const auto has_sun = [](const Scene& scene) {
    return std::ranges::any_of(scene.lights,
                               [](const Light& l) { return l.kind == Light::Kind::kSun; });
  };
  EXPECT_TRUE(has_sun(day));
  EXPECT_FALSE(has_sun(evening));
}

TEST(ScenarioData, TheRobotDoesNotRunIntoThePersonWhoWalksByInFrontOfIt) {
  const Scene room = load_scene(kFolder + "room.yaml");
  const Robot robot = load_robot(kFolder + "robot.yaml");
  const Pedestrian pedestrian = load_pedestrian(kFolder + "pedestrian.yaml");
  const DrivenPath path = drive(room, robot, load_tour(kFolder + "tours/room.yaml"));
  double nearest_m = 1e9;
  int seen = 0;
  for (std::size_t i = 0; i < path.base.size(); ++i) {
    const SE3 body = world_from_pedestrian(pedestrian, path.base[i].stamp_ns);
    nearest_m = std::min(
        nearest_m, (body.translation() - path.base[i].world_from_camera.translation()).norm());
    const Eigen::Vector3d chest = path.camera[i].world_from_camera.inverse() *
                                  (body.translation() + Eigen::Vector3d(0, 0, 1.2));
    seen += chest.z() > 0 && std::abs(chest.x()) < 0.5 * chest.z() ? 1 : 0;
  }
  EXPECT_GT(nearest_m, robot.footprint_radius_m + kPedestrianRadius_m);
  // The physics includes the pedestrian: the path is the same to the bit since the two do not
  // touch.
  const DrivenPath with_him =
      travel(room, robot, kFolder + "tours/room.yaml", {as_obstacle(room, pedestrian)});
  ASSERT_EQ(with_him.base.size(), path.base.size());
  for (std::size_t i = 0; i < path.base.size(); ++i) {
    const SE3 &a = with_him.base[i].world_from_camera, &b = path.base[i].world_from_camera;
    ASSERT_EQ(a.translation(), b.translation()) << i;
    ASSERT_EQ(a.rotation(), b.rotation()) << i;
  }
  EXPECT_GT(seen, static_cast<int>(path.base.size()) / 10);  // the pedestrian must be in view
}

TEST(JoinedPaths, GoOnAtTheCamerasRateFromAnotherPlace) {
  const auto straight = [](int frames, double x_m) {
    DrivenPath path;
    for (int i = 0; i < frames; ++i)
      path.camera.push_back(
          {std::llround(i * 1e9 / 15), SE3(Eigen::Matrix3d::Identity(), {x_m, 0.1 * i, 0})});
    path.base = path.camera;
    path.length_m = 0.1 * (frames - 1);
    return path;
  };
  const DrivenPath path = joined(straight(10, 0), straight(5, 7), 15);
  ASSERT_EQ(path.camera.size(), 15u);
  ASSERT_EQ(path.base.size(), 15u);
  for (std::size_t i = 0; i < 15; ++i)
    EXPECT_EQ(path.camera[i].stamp_ns, std::llround(static_cast<double>(i) * 1e9 / 15));
  EXPECT_EQ(path.camera[9].world_from_camera.translation().x(), 0);
  EXPECT_EQ(path.camera[10].world_from_camera.translation().x(), 7);
  EXPECT_NEAR(path.length_m, 0.9 + 0.4, 1e-12);  // the jump is not part of the distance driven
}

}  // namespace
}  // namespace mh
