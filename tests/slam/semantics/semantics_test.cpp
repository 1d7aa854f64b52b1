// SPDX-License-Identifier: Apache-2.0
#include <map>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"
#include "slam/semantics/augmented_vector.hpp"
#include "slam/semantics/candidate_selection.hpp"
#include "slam/semantics/descriptor_distance.hpp"

namespace mh {
namespace {

constexpr auto kUnitEta = [](std::uint32_t) { return 1.0; };

AugmentedVector vector_of(std::vector<Label> labels, std::vector<std::uint32_t> words,
                          double gamma) {
  return augmented_vector(std::span<const Label>(labels), std::span<const std::uint32_t>(words),
                          gamma, kUnitEta);
}

// Worked out by hand: labels {2, 2, void, 7} and words {5, 5, 9, 9} with gamma 0.5 and eta 1 for
// word 5, 3 for word 9. Weights: label 2: 0.5 * 2 = 1, label 7: 0.5, word 5: 2, word 9: 6; sum 9.5.
TEST(AugmentedVector, IsEquationOne) {
  const std::vector<Label> labels{2, 2, kNoLabel, 7};
  const std::vector<std::uint32_t> words{5, 9, 5, 9};
  const AugmentedVector v = augmented_vector(std::span(labels), std::span(words), 0.5,
                                             [](std::uint32_t w) { return w == 5 ? 1.0 : 3.0; });
  ASSERT_EQ(v.labels.size(), 2U);
  ASSERT_EQ(v.words.size(), 2U);
  EXPECT_DOUBLE_EQ(v.labels[0].weight, 1.0 / 9.5);
  EXPECT_DOUBLE_EQ(v.labels[1].weight, 0.5 / 9.5);
  EXPECT_DOUBLE_EQ(v.words[0].weight, 2.0 / 9.5);
  EXPECT_DOUBLE_EQ(v.words[1].weight, 6.0 / 9.5);
  EXPECT_DOUBLE_EQ(v.label_mass(), 1.5 / 9.5);
}

TEST(AugmentedVector, ZeroGammaLeavesNoLabelMember) {
  EXPECT_EQ(vector_of({1, 2, 3}, {4, 5, 6}, 0.0), vector_of({}, {4, 5, 6}, 1.0));
}

TEST(GammaForLabelMass, GivesTheWishedMassOnAverage) {
  // With words of weight 1, n labels and w words have the label mass gamma n / (gamma n + w).
  const auto share = [](int labels, int words, double gamma) {
    std::vector<Label> l(static_cast<std::size_t>(labels), 3);
    std::vector<std::uint32_t> w;
    for (int i = 0; i < words; ++i) w.push_back(static_cast<std::uint32_t>(i));
    return vector_of(l, w, gamma).label_mass();
  };
  const std::vector<double> one{share(4, 12, 1)};
  EXPECT_NEAR(gamma_for_label_mass(one, 0.2, 1e6), 0.75, 1e-12);  // 0.75 * 4 / (3 + 12)
  const std::vector<double> three{share(4, 12, 1), share(1, 30, 1), share(0, 9, 1)};
  for (const double wished : {0.005, 0.02, 0.2, 0.5}) {
    const double gamma = gamma_for_label_mass(three, wished, 1e6);
    EXPECT_NEAR((share(4, 12, gamma) + share(1, 30, gamma) + share(0, 9, gamma)) / 3, wished, 1e-9)
        << wished;
  }
  // One of the three vectors has no labels, so the mean is at most two thirds.
  EXPECT_NEAR(gamma_for_label_mass(three, 0.9, 1000), 1000, 1e-6);
  EXPECT_EQ(gamma_for_label_mass(std::vector<double>{0, 0}, 0.1, 1000), 0);
  EXPECT_EQ(gamma_for_label_mass({}, 0.1, 1000), 0);
}

TEST(AugmentedVector, VoidIsALabelOnlyOnRequest) {
  const std::vector<Label> labels{kNoLabel, kNoLabel};
  const std::vector<std::uint32_t> words{1};
  EXPECT_TRUE(vector_of(labels, words, 1.0).labels.empty());
  EXPECT_EQ(augmented_vector(std::span<const Label>(labels), std::span(words), 1.0, kUnitEta,
                             VoidPolicy::kIsALabel)
                .labels.size(),
            1U);
}

TEST(L1Similarity, IsOneMinusHalfTheL1Distance) {
  for (int trial = 0; trial < 50; ++trial) {
    const RandomStream random = RandomStream(1).fork(trial);
    const auto draw = [&](std::uint64_t name) {
      std::vector<Label> labels;
      std::vector<std::uint32_t> words;
      for (int i = 0; i < 40; ++i) {
        labels.push_back(static_cast<Label>(random.fork(name).below(i, 6)));
        words.push_back(static_cast<std::uint32_t>(random.fork(name + 1).below(i, 30)));
      }
      return vector_of(labels, words, 0.7);
    };
    const AugmentedVector a = draw(10), b = draw(20);
    std::map<std::pair<int, std::uint32_t>, double> difference;
    for (const auto& m : a.labels) difference[{0, m.id}] += m.weight;
    for (const auto& m : a.words) difference[{1, m.id}] += m.weight;
    for (const auto& m : b.labels) difference[{0, m.id}] -= m.weight;
    for (const auto& m : b.words) difference[{1, m.id}] -= m.weight;
    double l1 = 0;
    for (const auto& [key, d] : difference) l1 += std::abs(d);
    EXPECT_NEAR(l1_similarity(a, b), 1.0 - l1 / 2.0, 1e-12);
    EXPECT_DOUBLE_EQ(l1_similarity(a, b), l1_similarity(b, a));
    EXPECT_NEAR(l1_similarity(a, a), 1.0, 1e-12);
  }
}

TEST(SemanticDistance, IsEquationTwo) {
  EXPECT_EQ(semantic_distance(40.0F, labels_disagree(3, 3), 1.5F), 40.0F);
  EXPECT_EQ(semantic_distance(40.0F, labels_disagree(3, 4), 1.5F), 60.0F);
  EXPECT_EQ(semantic_distance(40.0F, labels_disagree(3, 4), 1.0F), 40.0F);
  EXPECT_FALSE(labels_disagree(kNoLabel, 4));
  EXPECT_TRUE(labels_disagree(kNoLabel, 4, VoidPolicy::kIsALabel));
  EXPECT_FALSE(labels_disagree(kNoLabel, kNoLabel, VoidPolicy::kIsALabel));
}

// Six keyframes worked out by hand. n: 0, 10, 8, 9, 10, 2. With alpha 0.8, n must exceed 8, so
// keyframes 1, 3 and 4 remain (keyframe 2 has exactly 8, which is not enough). Neighborhoods {1,
// 3}, {3, 1}, {4, 5}; similarities 1: 0.5, 3: 0.2, 4: 0.35, 5: 0.4. Keyframes 1 and 3 both choose 1
// with a = 0.7; keyframe 4 chooses 5 with a = 0.75. With beta 0.75, a must exceed 0.5625, so both
// choices remain, 5 first.
TEST(SelectCandidates, IsAlgorithmOne) {
  const std::vector<int> keyframes{0, 1, 2, 3, 4, 5};
  const int n[] = {0, 10, 8, 9, 10, 2};
  const std::vector<int> neighbors[] = {{0}, {1, 3}, {2}, {3, 1}, {4, 5}, {5}};
  const double similarity[] = {0.9, 0.5, 0.9, 0.2, 0.35, 0.4};
  const auto selection = select_candidates(
      std::span<const int>(keyframes), [&](int k) { return n[k]; },
      [&](int k) { return neighbors[k]; }, [&](int k) { return similarity[k]; }, 0.8, 0.75);
  EXPECT_EQ(selection.c1, 5);
  EXPECT_EQ(selection.c2, 3);
  EXPECT_EQ(selection.c3, 2);
  ASSERT_EQ(selection.candidates.size(), 2U);
  EXPECT_EQ(selection.candidates[0].keyframe, 5);
  EXPECT_DOUBLE_EQ(selection.candidates[0].score, 0.75);
  EXPECT_EQ(selection.candidates[1].keyframe, 1);
  EXPECT_DOUBLE_EQ(selection.candidates[1].score, 0.7);
}

TEST(SelectCandidates, BetaIsStrictAndTiesGoById) {
  const std::vector<int> keyframes{0, 1, 2};
  const double similarity[] = {0.75, 1.0, 1.0};
  const auto selection = select_candidates(
      std::span<const int>(keyframes), [](int) { return 1; }, [](int k) { return std::vector{k}; },
      [&](int k) { return similarity[k]; }, 0.5, 0.75);
  ASSERT_EQ(selection.candidates.size(), 2U);  // 0.75 is not greater than 0.75 * 1
  EXPECT_EQ(selection.candidates[0].keyframe, 1);
  EXPECT_EQ(selection.candidates[1].keyframe, 2);
}

// Keyframes 1 and 2 both choose 0: the first with a = 1.0 + 0.1, the second with 1.0 + 0.6.
TEST(SelectCandidates, ASharedBestIsKeptOnceWithItsLargestSum) {
  const std::vector<int> keyframes{1, 2};
  const std::vector<int> neighbors[] = {{0}, {1, 0}, {2, 0}};
  const double similarity[] = {1.0, 0.1, 0.6};
  const auto selection = select_candidates(
      std::span<const int>(keyframes), [](int) { return 1; }, [&](int k) { return neighbors[k]; },
      [&](int k) { return similarity[k]; }, 0.5, 0.75);
  EXPECT_EQ(selection.c3, 1);
  ASSERT_EQ(selection.candidates.size(), 1U);
  EXPECT_EQ(selection.candidates[0].keyframe, 0);
  EXPECT_DOUBLE_EQ(selection.candidates[0].score, 1.6);
}

// Equation 5 chooses the smallest id among equally similar neighbors, whatever their order; the
// keyframe itself counts as one of them.
TEST(SelectCandidates, OfEquallySimilarNeighborsTheLeastIsTaken) {
  const std::vector<int> keyframes{5};
  for (std::vector<int> neighbors : {std::vector{5, 7, 3, 4}, {3, 4, 5, 7}, {7, 4, 3, 5}}) {
    const auto selection = select_candidates(
        std::span<const int>(keyframes), [](int) { return 1; }, [&](int) { return neighbors; },
        [](int k) { return k == 7 ? 0.1 : 0.4; }, 0.5, 0.75);
    ASSERT_EQ(selection.candidates.size(), 1U);
    EXPECT_EQ(selection.candidates[0].keyframe, 3);
    EXPECT_DOUBLE_EQ(selection.candidates[0].score, 1.3);
  }
}

// A keyframe whose neighborhood has no similarity to the view chooses the smallest key among itself
// and its neighbors; equation 6 drops that choice if any other keyframe has some similarity.
TEST(SelectCandidates, AScoreOfNothingIsDropped) {
  const std::vector<int> keyframes{2, 3};
  const auto selection = select_candidates(
      std::span<const int>(keyframes), [](int) { return 1; }, [](int k) { return std::vector{k}; },
      [](int k) { return k == 2 ? 0.0 : 1e-9; }, 0.5, 0.75);
  EXPECT_EQ(selection.c3, 2);
  ASSERT_EQ(selection.candidates.size(), 1U);
  EXPECT_EQ(selection.candidates[0].keyframe, 3);
}

TEST(SelectCandidates, NothingSharedGivesNothing) {
  const std::vector<int> keyframes{0, 1};
  const auto selection = select_candidates(
      std::span<const int>(keyframes), [](int) { return 0; }, [](int k) { return std::vector{k}; },
      [](int) { return 1.0; }, 0.8, 0.75);
  EXPECT_EQ(selection.c1, 0);
  EXPECT_TRUE(selection.candidates.empty());
}

}  // namespace
}  // namespace mh
