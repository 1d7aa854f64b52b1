// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/true_space.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace mh {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using State = TrueSpace::State;

Scene scene_of(std::vector<Vector3f> corners, std::vector<std::array<std::uint32_t, 3>> faces) {
  Scene scene;
  scene.positions_m = std::move(corners);
  scene.material_of.assign(faces.size(), 0);
  scene.triangles = std::move(faces);
  scene.materials.resize(1);
  return scene;
}

std::set<std::array<int, 3>> surface_of(const TrueSpace& space) {
  std::set<std::array<int, 3>> found;
  for (int z = -2; z < 6; ++z)
    for (int y = -2; y < 6; ++y)
      for (int x = -2; x < 6; ++x)
        if (space.at({x, y, z}) == State::kSurface) found.insert({x, y, z});
  return found;
}

// A triangle that lies in a coordinate plane, for each of the three: it occupies the voxels below
// its longest side, and no other voxels of its bounding box.
TEST(TrueSpace, ATriangleIsInTheVoxelsThatItTouches) {
  for (int flat = 0; flat < 3; ++flat) {
    const auto turned = [&](auto a, auto b, auto c) {
      std::array<decltype(a), 3> place{a, b, c};
      std::rotate(place.begin(), place.begin() + flat, place.end());
      return place;
    };
    const auto corner = [&](float a, float b) {
      const auto [x, y, z] = turned(a, b, 0.5F);
      return Vector3f(x, y, z);
    };
    const Scene scene =
        scene_of({corner(0.1F, 0.1F), corner(3.8F, 0.1F), corner(0.1F, 3.8F)}, {{0, 1, 2}});
    std::set<std::array<int, 3>> expected;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; a + b < 4; ++b) expected.insert(turned(a, b, 0));
    EXPECT_EQ(surface_of(TrueSpace(scene, 1, {})), expected) << flat;
  }
}

// A slanted triangle occupies only four of the eight voxels of its bounding box.
TEST(TrueSpace, ASlantedTriangleMissesVoxelsOfItsBox) {
  const Scene scene =
      scene_of({{1.9F, 0.05F, 0.05F}, {0.05F, 1.9F, 0.05F}, {0.05F, 0.05F, 1.9F}}, {{0, 1, 2}});
  const TrueSpace space(scene, 1, {});
  EXPECT_EQ(space.at({0, 0, 0}), State::kSurface);
  EXPECT_EQ(space.at({1, 0, 0}), State::kSurface);
  EXPECT_EQ(space.at({1, 1, 0}), State::kClosed) << "x + y + z = 2 is its only corner";
  EXPECT_EQ(space.at({1, 1, 1}), State::kClosed);
  EXPECT_EQ(surface_of(space).size(), 4u);
}

TEST(TrueSpace, IsOpenWhereASeedIsAndClosedBehindWalls) {
  std::vector<Vector3f> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1) != 0 ? 3.5F : 0.5F, (i & 2) != 0 ? 3.5F : 0.5F,
                         (i & 4) != 0 ? 3.5F : 0.5F);
  const Scene box = scene_of(corners, {{0, 1, 3},
                                       {0, 3, 2},
                                       {4, 5, 7},
                                       {4, 7, 6},
                                       {0, 1, 5},
                                       {0, 5, 4},
                                       {2, 3, 7},
                                       {2, 7, 6},
                                       {0, 2, 6},
                                       {0, 6, 4},
                                       {1, 3, 7},
                                       {1, 7, 5}});
  const std::vector<Vector3d> seeds{{1.5, 2.5, 1.5}};
  const TrueSpace space(box, 1, seeds);
  EXPECT_EQ(surface_of(space).size(), 64u - 8u);
  for (const int x : {1, 2})
    for (const int y : {1, 2})
      for (const int z : {1, 2}) EXPECT_EQ(space.at({x, y, z}), State::kOpen);
  EXPECT_EQ(space.at({-1, 2, 2}), State::kClosed);
  EXPECT_EQ(space.at({100, 2, 2}), State::kClosed) << "outside of the scene";
  EXPECT_TRUE(space.is_near({-1, 2, 2}, State::kSurface));
  EXPECT_FALSE(space.is_near({-1, 2, 2}, State::kOpen));

  const OccupancyGrid plan = space.floor_plan(1, 3, seeds);
  int occupied = 0, free = 0;
  for (const std::int8_t cell : plan.cells) {
    occupied += cell == kOccupiedCell;
    free += cell == kFreeCell;
  }
  EXPECT_EQ(occupied, 12) << "the walls, not the floor";
  EXPECT_EQ(free, 4);
}

}  // namespace
}  // namespace mh
