// SPDX-License-Identifier: Apache-2.0
#include "scenes/floor.hpp"

#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "scenes/load.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "slam/io/error.hpp"
#include "tests/scenes/scanned_room.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

using test::ScannedRoom;
constexpr double kDegree = std::numbers::pi / 180;

double height_at(const Floor& floor, double x, double y) {
  const Eigen::Vector2d way = Eigen::Vector2d(x, y) - floor.middle_m.head<2>();
  return floor.middle_m.z() - floor.up.head<2>().dot(way) / floor.up.z();
}

class Labeled : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(FindFloor, Labeled, ::testing::Bool());

TEST_P(Labeled, FloorLiesWhereItsFacesAreHoweverRough) {
  for (const double noise_m : {0.0, 0.01, 0.015}) {
    const Scene scene = ScannedRoom{.noise_m = noise_m, .labeled = GetParam()}.build();
    const auto found = find_floor(scene);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->floor.middle_m.z(), 0.055, 0.001) << noise_m;
    EXPECT_EQ(found->floor.up, Eigen::Vector3d::UnitZ()) << noise_m;
    EXPECT_NEAR(*found->floor.area_m2, 30.0, 0.6) << noise_m;
    EXPECT_NEAR(found->floor.rough_m, std::max(0.03, 5 * noise_m), 0.01) << noise_m;
  }
}

TEST_P(Labeled, SlopeOfOneAndAHalfDegreesIsFollowed) {
  const Eigen::Vector2d slope = std::tan(1.5 * kDegree) * Eigen::Vector2d(0.8, -0.6);
  const Scene scene = ScannedRoom{.floor_z_m = 0.4, .slope = slope, .labeled = GetParam()}.build();
  const auto found = find_floor(scene);
  ASSERT_TRUE(found);
  EXPECT_NEAR(std::acos(found->floor.up.z()), 1.5 * kDegree, 0.02 * kDegree);
  for (const auto& [x, y] : {std::pair(-2.5, -2.0), {0.0, 0.0}, {2.5, 2.0}})
    EXPECT_NEAR(height_at(found->floor, x, y), 0.4 + slope.dot(Eigen::Vector2d(x, y)), 0.003);
  // In the floor's frame, the whole floor is close to z = 0, with nearly the same x and y.
  Scene with_floor = scene;
  with_floor.floor = found->floor;
  const LevelScene level(with_floor);
  for (std::size_t v = 0; v < 101 * 121; ++v) {
    EXPECT_LT(std::abs((*level).positions_m[v].z()), 0.06F);
    EXPECT_LT(((*level).positions_m[v] - scene.positions_m[v]).head<2>().norm(), 0.006F);
  }
}

TEST(FindFloor, SteeperThanTwoDegreesIsTakenAsLevelAndSaid) {
  std::vector<std::string> warnings;
  const Scene scene = ScannedRoom{.noise_m = 0, .slope = {std::tan(4 * kDegree), 0}}.build();
  const auto found = find_floor(scene, {}, &warnings);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->floor.up, Eigen::Vector3d::UnitZ());
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("slopes by 4.0 degrees"), std::string::npos) << warnings[0];
}

TEST_P(Labeled, HolesTakeAreaAwayAndNothingElse) {
  ScannedRoom room{.labeled = GetParam()};
  room.has_floor = [](double x, double y) { return x < 1 && (y > -1.5 || x < -2); };
  const auto found = find_floor(room.build());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->floor.middle_m.z(), 0.055, 0.002);
  EXPECT_NEAR(*found->floor.area_m2, 4.0 * 5 - 3.0 * 1, 0.4);  // not the 20 m2 of the bounding box
}

TEST(FindFloor, LargeTableIsNoFloorThoughNothingIsLabeled) {
  const ScannedRoom room{.labeled = false};
  Scene scene = room.build();
  room.add_table(scene, 4.5,
                 3.5);  // covers more than half of the floor: only the rest of the floor is found
  const auto found = find_floor(scene);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->floor.middle_m.z(), 0.055, 0.002);
  EXPECT_NEAR(*found->floor.area_m2, 30 - 4.5 * 3.5, 0.5);
}

TEST_P(Labeled, OfTwoLevelsTheLowerIsTheFloorUnlessItIsSmall) {
  for (const double upper_from_x : {0.0, -2.6}) {
    const ScannedRoom room{.noise_m = 0.005, .labeled = GetParam()};
    Scene scene = room.build();
    for (std::size_t v = 0; v < 101 * 121; ++v)  // a step of 0.6 m
      if (scene.positions_m[v].x() > upper_from_x) scene.positions_m[v].z() += 0.6F;
    const auto found = find_floor(scene);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->floor.middle_m.z(), upper_from_x == 0.0 ? 0.055 : 0.655, 0.003);
  }
}

TEST_P(Labeled, SlabIsTheFloorAndNotThePlaneBelowIt) {
  const ScannedRoom room{.floor_z_m = 0.2, .noise_m = 0, .labeled = GetParam()};
  Scene scene = room.build();
  ScannedRoom::add_sheet(scene, {-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, 1);
  const auto found = find_floor(scene);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->floor.middle_m.z(), 0.2, 1e-6);
  // With labels, all of the ground is floor; without them, only the part where things stand.
  EXPECT_NEAR(*found->floor.area_m2, GetParam() ? 1e4 : 30, GetParam() ? 50 : 0.6);
}

TEST(FindFloor, RoomEndsNearWhatStandsOnAGroundToTheHorizon) {
  Scene scene = ScannedRoom{.floor_z_m = 0, .noise_m = 0}.build();
  ScannedRoom::add_sheet(scene, {-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, 1);
  const auto found = find_floor(scene);
  ASSERT_TRUE(found);
  const auto box = [](const Room& room) {
    Eigen::AlignedBox2d all;
    for (const Eigen::Vector2d& corner : room.polygon_m) all.extend(corner);
    return all;
  };
  EXPECT_GT(box(found->room).sizes().minCoeff(), 99.0);
  const Room plan{.name = "plan", .polygon_m = found->room.polygon_m};
  const Room away{
      .name = "away", .polygon_m = {{20, 20}, {30, 20}, {30, 30}, {20, 30}}, .is_box = true};
  std::vector<Room> rooms = {found->room, plan, away};
  end_rooms_near_things(rooms, found->things_m);
  ASSERT_EQ(rooms.size(), 2U);  // rooms from a plan stay unchanged
  EXPECT_LT((box(rooms[0]).min() - Eigen::Vector2d(-5, -4.5)).norm(), 1e-6);
  EXPECT_LT((box(rooms[0]).max() - Eigen::Vector2d(5, 4.5)).norm(), 1e-6);
  EXPECT_GT(box(rooms[1]).sizes().minCoeff(), 99.0);
}

TEST(FindFloor, ThingAloneHasNone) {
  Scene scene = ScannedRoom{}.build();
  scene.triangles.clear();
  scene.material_of.clear(), scene.class_of.clear(), scene.instance_of.clear();
  ScannedRoom{}.add_table(scene, 1.6, 0.8);
  EXPECT_FALSE(find_floor(scene));
}

TEST(FindFloor, ItsHeightMayBeTold) {
  const auto found = find_floor(ScannedRoom{.labeled = false}.build(), 0.07);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->floor.middle_m.z(), 0.07);
  EXPECT_NEAR(*found->floor.area_m2, 30.0, 1.5);
}

TEST(FindFloor, FloorAtZeroIsZeroToTheBit) {
  for (const bool labeled : {true, false}) {
    const Scene scene = ScannedRoom{.floor_z_m = 0, .noise_m = 0, .labeled = labeled}.build();
    const auto found = find_floor(scene);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->floor.is_level_zero());
    EXPECT_EQ(found->floor.rough_m, 0.03);
  }
}

class LoadedFloor : public TemporaryFolder {};

/// Writes an OBJ with y or z up; the floor's faces are in a group of that name.
void write_obj(const Scene& scene, const std::filesystem::path& file, bool y_up) {
  std::ofstream out(file);
  for (const Eigen::Vector3f& p : scene.positions_m)
    out << "v " << p.x() << ' ' << (y_up ? p.z() : p.y()) << ' ' << (y_up ? -p.y() : p.z()) << '\n';
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    if (face == 0 || scene.instance_of[face] != scene.instance_of[face - 1])
      out << "o " << scene.instances[scene.instance_of[face] - 1U].name << '\n';
    const auto& [a, b, c] = scene.triangles[face];
    out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  }
}

TEST_F(LoadedFloor, FileWithYUpIsToldAndTheOptionTurnsIt) {
  for (const char* floor_name : {"floor", "part"}) {
    Scene room = ScannedRoom{.floor_z_m = 0.3, .noise_m = 0.002}.build();
    room.instances[0].name = floor_name;
    room.instances[1].name = "wall";
    // The ceiling is needed: otherwise, without a label, a wall would make an equally good floor.
    ScannedRoom::add_sheet(room, {-3, -2.5F, 2.8F}, {6, 0, 0}, {0, 5, 0}, 2);
    write_obj(room, folder_ / "room.obj", true);
    std::vector<std::string> warnings;
    load_scene(folder_ / "room.obj", &warnings);
    const auto reported = std::ranges::find_if(
        warnings, [](const std::string& w) { return w.find("try up: y (--up y)") != w.npos; });
    EXPECT_NE(reported, warnings.end()) << floor_name;
    warnings.clear();
    const Scene turned = load_scene(folder_ / "room.obj", &warnings, {.up = UpAxis::kY});
    EXPECT_TRUE(warnings.empty()) << warnings[0];
    EXPECT_NEAR(turned.floor.middle_m.z(), 0.3, 0.001);
    EXPECT_NEAR(turned.floor_area_m2(), 30, 0.6);
    Eigen::AlignedBox3f box, turned_box;
    for (const Eigen::Vector3f& p : room.positions_m) box.extend(p);
    for (const Eigen::Vector3f& p : turned.positions_m) turned_box.extend(p);
    EXPECT_TRUE(turned_box.isApprox(box, 1e-4F));
    write_obj(room, folder_ / "room.obj", false);
    warnings.clear();
    load_scene(folder_ / "room.obj", &warnings);
    EXPECT_TRUE(warnings.empty()) << warnings[0];
  }
}

TEST_F(LoadedFloor, PlacedSceneTellsItsFrame) {
  write_obj(ScannedRoom{.floor_z_m = 0.3, .noise_m = 0}.build(), folder_ / "room.obj", true);
  std::ofstream(folder_ / "scene.yaml") << "up: y\nfloor_z_m: 0.31\nobjects:\n  - file: room.obj\n";
  EXPECT_EQ(load_scene(folder_ / "scene.yaml").floor.middle_m.z(), 0.31);
  EXPECT_NEAR(load_scene(folder_ / "scene.yaml").floor_area_m2(), 30, 0.6);
  EXPECT_EQ(load_scene(folder_ / "scene.yaml", nullptr, {.floor_z_m = 0.29}).floor.middle_m.z(),
            0.29);
  std::ofstream(folder_ / "scene.yaml") << "objects:\n  - file: room.obj\n    up: y\n";
  EXPECT_NEAR(load_scene(folder_ / "scene.yaml").floor.middle_m.z(), 0.3, 1e-6);
  std::ofstream(folder_ / "scene.yaml") << "up: x\nobjects:\n  - file: room.obj\n";
  EXPECT_THROW(load_scene(folder_ / "scene.yaml"), InputError);
}

TEST_F(LoadedFloor, HouseCannotBeTurned) {
  EXPECT_TRUE(load_scene("generated:bathroom:2").floor.is_level_zero());
  EXPECT_THROW(load_scene("generated:bathroom:2", nullptr, {.up = UpAxis::kY}), InputError);
}

}  // namespace
}  // namespace mh
