// SPDX-License-Identifier: Apache-2.0
#include "slam/map/map.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

Keyframe keyframe_with(int features, const Vector6d& pose = Vector6d::Zero()) {
  Keyframe k;
  k.camera_from_world = SE3::exp(pose);
  k.features.keypoints.resize(static_cast<std::size_t>(features));
  k.features.descriptors.resize(static_cast<std::size_t>(features));
  return k;
}

/// Three keyframes; keyframes 0 and 1 share 20 landmarks, 1 and 2 share 16.
Map chain() {
  Map map;
  for (int i = 0; i < 3; ++i) {
    Vector6d pose = Vector6d::Zero();
    pose[0] = -0.1 * i;
    map.add(keyframe_with(40, pose));
  }
  for (std::uint32_t i = 0; i < 20; ++i)
    map.add_observation(map.add_landmark({0.1 * i, 0, 2}, KeyframeId{0}, i), KeyframeId{1}, i);
  for (std::uint32_t i = 20; i < 36; ++i)
    map.add_observation(map.add_landmark({0.1 * i, 0, 2}, KeyframeId{1}, i), KeyframeId{2}, i);
  for (std::uint32_t i = 0; i < 3; ++i) map.update_covisibility(KeyframeId{i});
  return map;
}

TEST(Map, CovisibilityCountsSharedLandmarks) {
  const Map map = chain();
  map.check_invariants();
  ASSERT_EQ(map.at(KeyframeId{1}).covisible.size(), 2U);
  EXPECT_EQ(map.at(KeyframeId{1}).covisible[0].id, KeyframeId{0});
  EXPECT_EQ(map.at(KeyframeId{1}).covisible[0].shared, 20);
  EXPECT_EQ(map.at(KeyframeId{1}).covisible[1].shared, 16);
  EXPECT_EQ(map.at(KeyframeId{0}).covisible.size(), 1U);
}

TEST(Map, FifteenSharedLandmarksMakeNeighborsAndFourteenDoNot) {
  for (const std::uint32_t shared : {14U, 15U}) {
    Map map;
    for (int i = 0; i < 2; ++i) map.add(keyframe_with(40));
    for (std::uint32_t i = 0; i < shared; ++i)
      map.add_observation(map.add_landmark({0.1 * i, 0, 2}, KeyframeId{0}, i), KeyframeId{1}, i);
    map.update_covisibility(KeyframeId{0});
    for (const KeyframeId id : {KeyframeId{0}, KeyframeId{1}})
      EXPECT_EQ(map.at(id).covisible.size(), shared == 15 ? 1U : 0U);
  }
}

TEST(Map, CovisibleAreByWhatTheyShareThenById) {
  Map map;
  for (int i = 0; i < 5; ++i) map.add(keyframe_with(100));
  const std::uint32_t shared[] = {0, 16, 17, 16, 17};  // number shared with keyframe 0
  std::uint32_t feature = 0;
  for (const std::uint32_t other : {4U, 3U, 2U, 1U})
    for (std::uint32_t i = 0; i < shared[other]; ++i, ++feature)
      map.add_observation(map.add_landmark({0.1 * i, 0, 2}, KeyframeId{0}, feature),
                          KeyframeId{other}, i);
  for (const std::uint32_t last : {4U, 3U, 2U, 1U, 0U}) map.update_covisibility(KeyframeId{last});
  std::vector<std::uint32_t> order;
  for (const Keyframe::Neighbor& n : map.at(KeyframeId{0}).covisible) order.push_back(n.id.value);
  EXPECT_EQ(order, (std::vector<std::uint32_t>{2, 4, 1, 3}));
}

TEST(Map, FuseMovesObservationsAndKeepsInvariants) {
  Map map = chain();
  const LandmarkId from = map.at(KeyframeId{0}).landmarks[3];
  const LandmarkId into = map.at(KeyframeId{2}).landmarks[25];
  map.fuse(from, into);
  map.check_invariants();
  EXPECT_TRUE(map.at(from).erased);
  // Keyframe 1 saw both: it keeps the observation of `into` and loses that of `from`.
  EXPECT_EQ(map.at(into).observations.size(), 3U);
  EXPECT_EQ(map.at(KeyframeId{0}).landmarks[3], into);
  EXPECT_EQ(map.at(KeyframeId{1}).landmarks[25], into);
  EXPECT_FALSE(map.at(KeyframeId{1}).landmarks[3].valid());
  EXPECT_EQ(map.landmark_count(), 35);
}

TEST(Map, AnErasedKeyframesPoseMovesWithItsParent) {
  Map map = chain();
  const SE3 before = map.camera_from_world(KeyframeId{1});
  map.erase(KeyframeId{1});
  map.check_invariants();
  EXPECT_EQ(map.keyframe_count(), 2);
  EXPECT_EQ(map.live_keyframe(KeyframeId{1}), KeyframeId{0});
  EXPECT_LT((before * map.camera_from_world(KeyframeId{1}).inverse()).log().norm(), 1e-12);
  const SE3 moved = SE3::exp((Vector6d() << 1, 2, 3, 0.1, 0, 0).finished());
  map.set_pose(KeyframeId{0}, map.at(KeyframeId{0}).camera_from_world * moved);
  EXPECT_LT((before * moved * map.camera_from_world(KeyframeId{1}).inverse()).log().norm(), 1e-9);
}

TEST(Map, RandomOperationsKeepInvariants) {
  const RandomStream random(11);
  Map map = chain();
  for (std::uint64_t i = 0; i < 300; ++i) {
    const RandomStream draw = random.fork(i);
    const auto landmark =
        LandmarkId{static_cast<std::uint32_t>(draw.below(0, map.landmarks().size()))};
    const auto other =
        LandmarkId{static_cast<std::uint32_t>(draw.below(1, map.landmarks().size()))};
    const auto keyframe =
        KeyframeId{static_cast<std::uint32_t>(draw.below(2, map.keyframes().size()))};
    const auto feature = static_cast<std::uint32_t>(draw.below(3, 40));
    switch (draw.below(4, 6)) {
      case 0:
        map.fuse(landmark, other);
        break;
      case 1:
        map.erase_observation(landmark, keyframe);
        break;
      case 2:
        if (!map.at(keyframe).erased && !map.at(keyframe).landmarks[feature].valid())
          map.add_landmark({0, 0, 1}, keyframe, feature);
        break;
      case 3:
        if (!map.at(keyframe).erased) map.add_observation(landmark, keyframe, feature);
        break;
      case 4:
        map.update_covisibility(keyframe);
        break;
      default:
        map.add(keyframe_with(40));
        if (i % 20 == 0) map.erase(keyframe);
    }
    ASSERT_NO_THROW(map.check_invariants()) << "after operation " << i;
  }
}

TEST(Map, LabelComesWithTheRepresentativeDescriptor) {
  Map map;
  for (int i = 0; i < 3; ++i) {
    Keyframe k = keyframe_with(1);
    k.features.keypoints[0].label = static_cast<ClassId>(10 + i);
    // Distances: 0-1: 8 bits, 1-2: 8 bits, 0-2: 16 bits; the middle one is the most central.
    k.features.descriptors[0] = {i == 0 ? 0xffULL : 0ULL, i == 2 ? 0xffULL : 0ULL, 0, 0};
    map.add(k);
  }
  const LandmarkId id = map.add_landmark({0, 0, 2}, KeyframeId{0}, 0);
  map.add_observation(id, KeyframeId{1}, 0);
  map.add_observation(id, KeyframeId{2}, 0);
  map.refresh(id, FeatureConfig{});
  EXPECT_EQ(map.at(id).label, 11);
  EXPECT_EQ(map.at(id).descriptor, map.at(KeyframeId{1}).features.descriptors[0]);
}

TEST(Map, TheRepresentativeDescriptorHasTheLeastMedianDistanceToTheOthers) {
  const RandomStream random(5);
  for (std::uint32_t n = 3; n <= 40; ++n) {
    Map map;
    std::vector<Descriptor> all(n);
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint64_t word = 0; word < 4; ++word)
        all[i][word] = random.fork(n).bits(4 * i + word);
      Keyframe k = keyframe_with(1);
      k.features.descriptors[0] = all[i];
      map.add(k);
    }
    const LandmarkId id = map.add_landmark({0, 0, 2}, KeyframeId{0}, 0);
    for (std::uint32_t i = 1; i < n; ++i) map.add_observation(id, KeyframeId{i}, 0);
    map.refresh(id, FeatureConfig{});
    std::vector<std::pair<int, std::uint32_t>> medians;
    for (std::uint32_t i = 0; i < n; ++i) {
      std::vector<int> others;
      for (std::uint32_t j = 0; j < n; ++j)
        if (j != i) others.push_back(hamming(all[i], all[j]));
      std::sort(others.begin(), others.end());
      medians.emplace_back(others[others.size() / 2], i);
    }
    const auto [median, first] = *std::min_element(medians.begin(), medians.end());
    EXPECT_EQ(map.at(id).descriptor, all[first]) << n << " descriptors, least median " << median;
  }
}

TEST(Map, DigestSeesAMovedPoseAndALandmark) {
  Map map = chain();
  const auto digest = map.digest();
  EXPECT_EQ(digest, chain().digest());
  map.set_position(LandmarkId{5}, {1, 1, 1});
  EXPECT_NE(digest, map.digest());
}

}  // namespace
}  // namespace mh
