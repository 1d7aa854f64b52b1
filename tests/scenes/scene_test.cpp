// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "slam/io/error.hpp"

namespace mh {
namespace {

Scene triangle_scene() {
  Scene scene;
  scene.name = "test";
  scene.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.uvs = {{0, 0}, {1, 0}, {0, 1}};
  scene.colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  scene.light = {{1, 1, 1}, {2, 1, 1}, {1, 3, 1}};
  scene.triangles = {{0, 1, 2}};
  scene.material_of = {0};
  scene.class_of = {5};
  scene.instance_of = {2};
  scene.materials = {{.name = "m", .texture = Grid2d<Rgb8>(2, 2)}};
  scene.instances = {{.id = 2, .class_id = 5, .name = "chair"}};
  scene.lights = {Light{}};
  return scene;
}

using Change = std::function<void(Scene&)>;

TEST(ValidateScene, AcceptsAGoodSceneAndRefusesEveryFlaw) {
  EXPECT_NO_THROW(validate(triangle_scene()));
  const std::vector<Change> flaws = {
      [](Scene& s) { s.uvs.pop_back(); },
      [](Scene& s) { s.colors.pop_back(); },
      [](Scene& s) { s.light.pop_back(); },
      [](Scene& s) { s.material_of.clear(); },
      [](Scene& s) { s.class_of.push_back(1); },
      [](Scene& s) { s.instance_of.clear(); },
      [](Scene& s) { s.positions_m[1].x() = NAN; },
      [](Scene& s) { s.positions_m[1].y() = 1e30F; },
      [](Scene& s) { s.uvs[0].x() = INFINITY; },
      [](Scene& s) { s.light[0].x() = -1; },
      [](Scene& s) { s.triangles[0][2] = 3; },
      [](Scene& s) { s.material_of[0] = 1; },
      [](Scene& s) { s.class_of[0] = 200; },
      [](Scene& s) { s.instance_of[0] = 1; },
      [](Scene& s) { s.materials[0].tile_m.x() = 0; },
      [](Scene& s) { s.materials[0].emission.y() = -1; },
      [](Scene& s) { s.uvs.clear(); },  // although a material has a texture
      [](Scene& s) { s.instances[0].id = 0; },
      [](Scene& s) { s.instances.push_back(s.instances[0]); },
      [](Scene& s) { s.instances.push_back({.id = 3, .class_id = 5, .name = "chair"}); },
      [](Scene& s) { s.instances[0].class_id = 250; }};
  for (std::size_t i = 0; i < flaws.size(); ++i) {
    Scene scene = triangle_scene();
    flaws[i](scene);
    EXPECT_THROW(validate(scene), InputError) << "flaw " << i;
  }
}

TEST(DigestScene, SeesEveryVisibleChangeAndNothingElse) {
  const std::vector<Change> changes = {
      [](Scene& s) { s.positions_m[0].x() = 1e-6F; },
      [](Scene& s) { s.uvs[1].y() = 0.5F; },
      [](Scene& s) { s.colors[0].g = 77; },
      [](Scene& s) { s.light[2].z() = 0.5F; },
      [](Scene& s) { std::swap(s.triangles[0][0], s.triangles[0][1]); },
      [](Scene& s) { s.class_of[0] = 6; },
      [](Scene& s) { s.instance_of[0] = 0; },
      [](Scene& s) {
        s.materials[0].texture = Grid2d<Rgb8>(2, 2, {0, 0, 1});
      },
      [](Scene& s) { s.materials[0].texture = Grid2d<Rgb8>(4, 1); },
      [](Scene& s) { s.materials[0].base_color.r = 3; },
      [](Scene& s) { s.materials[0].emission.x() = 1; },
      [](Scene& s) { s.lights[0].color.x() = 2; },
      [](Scene& s) { s.lights.clear(); },
      [](Scene& s) { s.light.clear(); }};
  std::set<std::uint64_t> seen{digest(triangle_scene())};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Scene scene = triangle_scene();
    changes[i](scene);
    EXPECT_TRUE(seen.insert(digest(scene)).second) << "change " << i;
  }
  Scene renamed = triangle_scene();
  renamed.name = "other";
  EXPECT_EQ(digest(renamed), digest(triangle_scene()));
}

TEST(FloorArea, IsThatOfTheRooms) {
  Scene scene;
  EXPECT_EQ(scene.floor_area_m2(), 0.0);
  scene.rooms = {{.name = "a", .polygon_m = {{1, 1}, {5, 1}, {5, 4}, {1, 4}}},
                 {.name = "l", .polygon_m = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}}};
  EXPECT_DOUBLE_EQ(scene.floor_area_m2(), 12.0 + 3.0);
}

}  // namespace
}  // namespace mh
