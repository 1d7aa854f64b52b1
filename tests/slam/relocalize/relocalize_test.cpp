// SPDX-License-Identifier: Apache-2.0
#include "slam/relocalize/relocalize.hpp"
#include "slam/config/slam.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

AugmentedVector vector_of(std::vector<Label> labels, std::vector<std::uint32_t> words) {
  return augmented_vector(std::span<const Label>(labels), std::span<const std::uint32_t>(words),
                          1.0, [](std::uint32_t) { return 1.0; });
}

/// Keyframes that share no landmarks: each is its own neighborhood.
Map map_of(const std::vector<AugmentedVector>& vectors) {
  Map map;
  for (const AugmentedVector& vector : vectors) {
    Keyframe keyframe;
    keyframe.words.vector = vector;
    map.add(std::move(keyframe));
  }
  return map;
}

// A query with labels {5, 6} and words {1, 2, 3, 4}. Keyframe 0 shares both labels and no word,
// keyframe 1 four words and no label, keyframe 2 one label and three words.
class SelectKeyframes : public testing::Test {
 protected:
  const AugmentedVector query_ = vector_of({5, 6}, {1, 2, 3, 4});
  const Map map_ = map_of({vector_of({5, 6}, {10, 11, 12, 13}), vector_of({7, 8}, {1, 2, 3, 4}),
                           vector_of({5, 8}, {1, 2, 3, 13})});
  std::vector<std::uint32_t> select(Overlap overlap, const AugmentedVector& query) const {
    std::vector<std::uint32_t> ids;
    const SemanticConfig config{.alpha = 0.8, .beta = 0.0, .overlap = overlap};
    for (const auto& candidate : select_keyframes(map_, query, config).candidates)
      ids.push_back(candidate.keyframe.value);
    std::sort(ids.begin(), ids.end());
    return ids;
  }
};

TEST_F(SelectKeyframes, OverlapDecidesWhatEquationThreeCounts) {
  using Ids = std::vector<std::uint32_t>;
  EXPECT_EQ(select(Overlap::kLabels, query_), Ids({0}));        // n = 2, -, 1
  EXPECT_EQ(select(Overlap::kWords, query_), Ids({1}));         // n = -, 4, 3: 3 is not over 3.2
  EXPECT_EQ(select(Overlap::kAugmented, query_), Ids({1, 2}));  // n = 2, 4, 4
}

TEST_F(SelectKeyframes, WithoutLabelsWordsAreCounted) {
  EXPECT_EQ(select(Overlap::kLabels, vector_of({}, {1, 2, 3, 4})), std::vector<std::uint32_t>({1}));
}

TEST_F(SelectKeyframes, ErasedKeyframesAreNoCandidates) {
  Map map = map_;
  map.erase(KeyframeId{1});
  const auto selection = select_keyframes(map, query_, {.overlap = Overlap::kWords});
  ASSERT_EQ(selection.candidates.size(), 1U);
  EXPECT_EQ(selection.candidates[0].keyframe, KeyframeId{2});
}

TEST(Relocalize, AnEmptyMapHasNoCandidate) {
  const Features features;
  const FeatureGrid grid(features.keypoints, Camera{});
  const WordIndex words;
  MatchCounts counts{};
  const auto result =
      relocalize({features, grid, words}, {Camera{}, SlamConfig{}, Map{}, counts}, RandomStream(1));
  EXPECT_EQ(result.stage, RelocalizationStage::kNoCandidate);
  EXPECT_FALSE(result.camera_from_world.has_value());
}

// A keyframe of 60 points and a frame from beside it that sees them all without noise; the first
// feature and the last may lie. What is found is each true one, no other, and the exact pose.
TEST(Relocalize, FindsEachTrueLandmarkAndTheExactPose) {
  const Camera camera;
  const SlamConfig config;
  constexpr std::uint32_t kPoints = 60;
  const SE3 truth = SE3::exp((Vector6d() << 0.1, -0.05, 0.12, 0.03, -0.06, 0.02).finished());
  const auto keypoint = [&](const Eigen::Vector3d& p) {
    Keypoint k;
    k.u_px = static_cast<float>(camera.project(p).x());
    k.v_px = static_cast<float>(camera.project(p).y());
    k.depth_m = static_cast<float>(p.z());
    return k;
  };
  for (const bool lies : {false, true}) {
    Keyframe keyframe;
    Features features;
    WordIndex words;
    std::vector<Eigen::Vector3d> points;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      const RandomStream draw = RandomStream(4).fork(i);
      points.push_back(camera.unproject(draw.uniform(0, 120, 520), draw.uniform(1, 100, 380),
                                        draw.uniform(2, 2, 4)));
      keyframe.features.keypoints.push_back(keypoint(points[i]));
      keyframe.features.descriptors.push_back(
          {draw.bits(3), draw.bits(4), draw.bits(5), draw.bits(6)});
      keyframe.words.by_node.emplace_back(i, i);
      features.keypoints.push_back(keypoint(truth * points[i]));
      if (lies && (i == 0 || i == kPoints - 1)) features.keypoints[i].u_px += 60;
    }
    features.descriptors = keyframe.features.descriptors;
    words.by_node = keyframe.words.by_node;
    words.vector = keyframe.words.vector = vector_of({}, {1, 2, 3});
    Map map;
    map.add(std::move(keyframe));
    for (std::uint32_t i = 0; i < kPoints; ++i)
      map.refresh(map.add_landmark(points[i], KeyframeId{0}, i), config.features);
    const FeatureGrid grid(features.keypoints, camera);
    MatchCounts counts{};
    const auto found =
        relocalize({features, grid, words}, {camera, config, map, counts}, RandomStream(1));
    EXPECT_EQ(found.stage, RelocalizationStage::kVerified);
    EXPECT_EQ(found.keyframe, KeyframeId{0});
    EXPECT_EQ(found.inliers, static_cast<int>(lies ? kPoints - 2 : kPoints));
    ASSERT_TRUE(found.camera_from_world);
    EXPECT_LT((*found.camera_from_world * truth.inverse()).log().norm(), 1e-5);
    ASSERT_EQ(found.landmarks.size(), kPoints);
    for (std::uint32_t i = 0; i < kPoints; ++i)
      EXPECT_EQ(found.landmarks[i],
                lies && (i == 0 || i == kPoints - 1) ? LandmarkId{} : LandmarkId{i})
          << i;
  }
}

}  // namespace
}  // namespace mh
