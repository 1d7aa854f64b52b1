// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"
#include "slam/map/id_set.hpp"
#include "slam/map/map.hpp"
#include "slam/map/position_index.hpp"

namespace mh {
namespace {

AugmentedVector random_view(RandomStream random) {
  std::vector<Label> labels;
  std::vector<std::uint32_t> words;
  for (std::uint64_t i = 0; i < 60; ++i) {
    labels.push_back(static_cast<Label>(random.fork(0).below(i, 6)));
    words.push_back(static_cast<std::uint32_t>(random.fork(1).below(i, 500)));
  }
  return augmented_vector(std::span<const Label>(labels), std::span<const std::uint32_t>(words),
                          1.0, [](std::uint32_t word) { return word % 7 == 0 ? 0.0 : 1.0; });
}

TEST(IdSet, HoldsWhatAStandardSetHolds) {
  const RandomStream random(1);
  IdSet<LandmarkId> ours;
  std::set<std::uint32_t> standard;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    // Sparse and dense ids in turn, so that pages are both created and found again.
    const auto id = static_cast<std::uint32_t>(random.below(i, i % 2 == 0 ? 1000000 : 3000));
    EXPECT_EQ(ours.insert(LandmarkId{id}), standard.insert(id).second) << id;
  }
  for (std::uint32_t id = 0; id < 8000; ++id)
    ASSERT_EQ(ours.contains(LandmarkId{id}), standard.contains(id)) << id;
  EXPECT_FALSE(ours.contains(LandmarkId{5000000}));
}

TEST(PositionIndex, FindsAllThatIsNearAndLittleElse) {
  const RandomStream random(3);
  const auto place = [&](std::uint64_t i) {
    return Eigen::Vector3d(random.uniform(3 * i, -30, 30), random.uniform(3 * i + 1, -30, 30),
                           random.uniform(3 * i + 2, -3, 3));
  };
  PositionIndex index;
  for (std::uint32_t i = 0; i < 900; ++i) index.add(KeyframeId{i}, place(i));
  for (std::uint32_t i = 0; i < 900; i += 3) index.remove(KeyframeId{i}, place(i));

  for (const double radius : {0.0, 1.0, 2.5, 9.0, 1e6})
    for (std::uint64_t q = 0; q < 20; ++q) {
      const Eigen::Vector3d center = place(q);
      const std::vector<KeyframeId> found = index.near(center, radius);
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
      for (std::uint32_t i = 0; i < 900; ++i) {
        const bool listed = std::binary_search(found.begin(), found.end(), KeyframeId{i});
        const bool stands = i % 3 != 0;
        const double distance = (place(i) - center).norm();
        if (stands && distance <= radius) {
          EXPECT_TRUE(listed) << i << " at " << distance;
        }
        // The cubes that the ball's bounding box touches reach no farther than this distance.
        if (!stands || distance > 2 * (radius + 2.5) * std::sqrt(3.0)) {
          EXPECT_FALSE(listed) << i << " at " << distance;
        }
      }
    }
}

TEST(Map, IndicesFollowKeyframesThatMoveAndGo) {
  Map map;
  for (std::uint64_t i = 0; i < 3; ++i) {
    Keyframe keyframe;
    keyframe.words.vector = random_view(RandomStream(i));
    map.add(std::move(keyframe));
  }
  const Eigen::Vector3d far(100, 0, 0);
  map.set_pose(KeyframeId{1}, SE3(Eigen::Matrix3d::Identity(), -far));  // the camera is at `far`
  EXPECT_EQ(map.keyframes_near(far, 1.0), std::vector{KeyframeId{1}});
  map.erase(KeyframeId{2});
  EXPECT_EQ(map.keyframes_near(Eigen::Vector3d::Zero(), 1.0), std::vector{KeyframeId{0}});
  const auto sharing = map.sharing(random_view(RandomStream(0)));
  ASSERT_EQ(sharing.size(), 2U);
  EXPECT_EQ(sharing[0].keyframe, KeyframeId{0});
  EXPECT_EQ(sharing[1].keyframe, KeyframeId{1});
  map.check_invariants();
}

}  // namespace
}  // namespace mh
