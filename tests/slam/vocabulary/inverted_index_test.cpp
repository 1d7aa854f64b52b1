// SPDX-License-Identifier: Apache-2.0
#include "slam/vocabulary/inverted_index.hpp"

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

// A view with at most 5 labels and about 60 words out of 200, some of them several times.
AugmentedVector view(std::uint64_t seed) {
  const RandomStream random(seed);
  std::vector<Label> labels;
  std::vector<std::uint32_t> words;
  for (std::uint64_t i = 0; i < 70; ++i) {
    labels.push_back(static_cast<Label>(random.fork(1).below(i, 1 + random.below(0, 5))));
    words.push_back(static_cast<std::uint32_t>(random.fork(2).below(i, 200)));
  }
  return augmented_vector(labels, words, 0.7, [](std::uint32_t w) { return w % 7 * 0.31; });
}

std::vector<InvertedIndex::Score> by_brute_force(const AugmentedVector& query,
                                                 const std::vector<std::uint32_t>& keyframes) {
  std::vector<InvertedIndex::Score> scores;
  for (const std::uint32_t k : keyframes) {
    const AugmentedVector v = view(k);
    const InvertedIndex::Score score{KeyframeId{k}, shared_labels(query, v), shared_words(query, v),
                                     l1_similarity(query, v)};
    if (score.shared_labels + score.shared_words > 0) scores.push_back(score);
  }
  return scores;
}

TEST(InvertedIndex, EqualsTheSimilarityToEachKeyframeBitForBit) {
  InvertedIndex index;
  std::vector<std::uint32_t> held;
  for (std::uint32_t k = 0; k < 40; k += 1 + k % 3) {
    index.add(KeyframeId{k}, view(k));
    held.push_back(k);
  }
  EXPECT_EQ(index.size(), held.size());
  for (std::uint64_t q = 1000; q < 1020; ++q)
    EXPECT_EQ(index.query(view(q)), by_brute_force(view(q), held));
  // A view has the largest possible similarity to itself.
  for (const auto& score : index.query(view(0)))
    if (score.keyframe.value == 0) {
      EXPECT_NEAR(score.similarity, 1.0, 1e-12);
    }
}

TEST(InvertedIndex, NothingSharedIsNotListed) {
  InvertedIndex index;
  AugmentedVector words, labels;
  words.words = {{3, 0.5}, {9, 0.5}};
  labels.labels = {{3, 1.0}};
  index.add(KeyframeId{4}, words);
  index.add(KeyframeId{6}, labels);
  EXPECT_TRUE(index.query({}).empty());
  // Label 3 and word 3 are different.
  ASSERT_EQ(index.query(labels).size(), 1U);
  EXPECT_EQ(index.query(labels)[0], (InvertedIndex::Score{KeyframeId{6}, 1, 0, 1.0}));
  EXPECT_EQ(index.query(words)[0], (InvertedIndex::Score{KeyframeId{4}, 0, 2, 1.0}));
}

TEST(InvertedIndex, TheOrderOfComingAndGoingChangesNothing) {
  InvertedIndex forwards, backwards;
  for (std::uint32_t k = 0; k < 30; ++k) forwards.add(KeyframeId{k}, view(k));
  for (std::uint32_t k = 30; k-- > 0;) backwards.add(KeyframeId{k}, view(k));
  std::vector<std::uint32_t> left;
  for (std::uint32_t k = 0; k < 30; ++k)
    if (k % 4 == 1) {
      forwards.erase(KeyframeId{k}, view(k));
      backwards.erase(KeyframeId{k}, view(k));
    } else {
      left.push_back(k);
    }
  EXPECT_EQ(forwards.size(), left.size());
  const AugmentedVector query = view(99);
  EXPECT_EQ(forwards.query(query), by_brute_force(query, left));
  EXPECT_EQ(backwards.query(query), forwards.query(query));
  // A keyframe whose erasure was undone is added again.
  forwards.add(KeyframeId{1}, view(1));
  left.insert(left.begin() + 1, 1);
  EXPECT_EQ(forwards.query(query), by_brute_force(query, left));
}

}  // namespace
}  // namespace mh
