// SPDX-License-Identifier: Apache-2.0
#include "slam/relocalize/relocalize.hpp"
#include "slam/config/slam.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace mh
