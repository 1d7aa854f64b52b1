// SPDX-License-Identifier: Apache-2.0
#include "scenes/vocabulary_rooms/vocabulary_rooms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "scenes/materials/materials.hpp"
#include "scenes/vocabulary_rooms/patterns.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

TEST(TrainingRoom, FollowsFromItsSeedAlone) {
  std::set<std::uint64_t> digests;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const std::uint64_t first = digest(make_training_room(seed));
    EXPECT_EQ(first, digest(make_training_room(seed)));
    EXPECT_TRUE(digests.insert(first).second) << seed;
  }
}

TEST(TrainingRoom, SharesNoMaterialWithTheHouse) {
  const auto house = material_kinds();
  ASSERT_GE(training_patterns().size(), 10U);
  for (const std::string_view family : training_patterns())
    EXPECT_EQ(std::ranges::find(house, family), house.end()) << family;
  std::size_t seen = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (const Material& material : make_training_room(seed).materials) {
      ++seen;
      EXPECT_TRUE(material.name.starts_with("training/")) << material.name;
      EXPECT_EQ(std::ranges::find(house, std::string_view(material.name)), house.end());
    }
  EXPECT_GT(seen, 20U);
}

TEST(TrainingRoom, IsAClosedFurnishedRoomInMeters) {
  const Scene room = make_training_room(3);
  EXPECT_GT(room.floor_area_m2(), 9.0);
  EXPECT_LT(room.floor_area_m2(), 31.0);
  EXPECT_GT(room.instances.size(), 15U);
  EXPECT_GE(room.lights.size(), 2U);
  EXPECT_TRUE(room.light.empty());
  EXPECT_LT(room.triangles.size(), 60000U);
}

TEST(TrainingPattern, FamiliesAndSeedsDiffer) {
  std::vector<SharedGrid<Rgb8>> seen;
  for (const std::string_view family : training_patterns())
    for (const std::uint64_t seed : {1, 2}) {
      const Material material = make_training_pattern(family, seed);
      EXPECT_EQ(std::ranges::find(seen, material.texture), seen.end()) << family;
      seen.push_back(material.texture);
      EXPECT_EQ(material.texture, make_training_pattern(family, seed).texture) << family;
    }
  EXPECT_THROW(make_training_pattern("wood_grain", 0), InputError);
}

TEST(TrainingViews, StandFreeAndUprightInsideTheRoom) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Scene room = make_training_room(seed);
    const auto views = training_views(room, seed, 40);
    ASSERT_EQ(views.size(), 40U);
    const Eigen::Vector2d far = room.rooms[0].polygon_m[2];
    for (const SE3& world_from_camera : views) {
      const Eigen::Vector3d at = world_from_camera.translation();
      EXPECT_GE(at.z(), 0.8);
      EXPECT_LE(at.z(), 1.6);
      EXPECT_TRUE(at.x() > 0.25 && at.y() > 0.25 && at.x() < far.x() - 0.25 &&
                  at.y() < far.y() - 0.25);
      const Eigen::Matrix3d axes = world_from_camera.rotation();
      EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
      EXPECT_NEAR((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12);
      EXPECT_LT(axes(2, 1), -0.85) << "the image's down must point down";
      EXPECT_LT(std::abs(axes(2, 2)), 0.5) << "looks about level";
      for (const Instance& instance : room.instances) {
        const Eigen::Vector3f p = at.cast<float>();
        const bool within = (p.array() > instance.min_m.array()).all() &&
                            (p.array() < instance.max_m.array()).all();
        EXPECT_FALSE(within) << instance.name;
      }
    }
  }
}

TEST(TrainingViews, FollowFromTheirSeed) {
  const Scene room = make_training_room(1);
  const auto a = training_views(room, 5, 3), b = training_views(room, 5, 3),
             c = training_views(room, 6, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(a[i].translation(), b[i].translation());
    EXPECT_EQ(a[i].rotation(), b[i].rotation());
    EXPECT_NE(a[i].translation(), c[i].translation());
  }
  EXPECT_THROW(training_views(Scene{}, 0, 1), InputError);
}

}  // namespace
}  // namespace mh
