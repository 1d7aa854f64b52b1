// SPDX-License-Identifier: Apache-2.0
#include "bench/results/statistics.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

std::vector<PairedDifference> all_equal_to(double value, std::size_t n) {
  return std::vector<PairedDifference>(n, {value, true});
}

TEST(Median, IsTheMiddleOrTheMeanOfTheMiddleTwo) {
  EXPECT_EQ(median({}), 0);
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
}

TEST(Median, LeavesOutWhatIsUnknown) {
  EXPECT_EQ(median_of_known({}), std::nullopt);
  EXPECT_EQ(median_of_known(std::vector<std::optional<double>>{std::nullopt, 3, 1, std::nullopt}),
            2);
  EXPECT_EQ(median_of_known(std::vector<std::optional<double>>(2)), std::nullopt);
}

TEST(ComparePaired, NoDifferenceIsNeverSignificant) {
  const Comparison c = compare_paired(all_equal_to(0, 50), true, 1);
  EXPECT_EQ(c.difference, 0);
  EXPECT_EQ(c.p, 1);
  EXPECT_DOUBLE_EQ(c.detectable, 3.0 / 50);  // the rule of three
  EXPECT_EQ(verdict(c), Verdict::kUndecided);
}

TEST(ComparePaired, AConstantDifferenceIsFoundAndHasNoSpread) {
  Comparison c[] = {compare_paired(all_equal_to(0.5, 50), false, 1)};
  holm(c);
  EXPECT_DOUBLE_EQ(c[0].low, 0.5);
  EXPECT_DOUBLE_EQ(c[0].high, 0.5);
  EXPECT_EQ(verdict(c[0]), Verdict::kFirstBetter);
  c[0].more_is_better = false;
  EXPECT_EQ(verdict(c[0]), Verdict::kSecondBetter);
}

TEST(ComparePaired, AnswersOfOneNeighborhoodCountLessThanTheirNumber) {
  // Blocks of ten queries with equal values carry hardly more information than one query per block.
  std::vector<PairedDifference> runs, mixed;
  for (int i = 0; i < 200; ++i) {
    runs.push_back({(i / 10) % 2 == 0 ? 1.0 : -0.9, true});
    mixed.push_back({i % 2 == 0 ? 1.0 : -0.9, true});
  }
  const Comparison a = compare_paired(runs, false, 1), b = compare_paired(mixed, false, 1);
  EXPECT_DOUBLE_EQ(a.difference, b.difference);
  EXPECT_GT(a.detectable, 3 * b.detectable);
}

TEST(ComparePaired, TooFewPairsDecideNothing) {
  std::vector<PairedDifference> few = all_equal_to(1, 3);
  few.resize(40);  // the others have no value
  const Comparison c = compare_paired(few, true, 1);
  EXPECT_EQ(c.pairs, 3u);
  EXPECT_EQ(verdict(c), Verdict::kUndecided);
}

TEST(ComparePaired, FewBlocksCannotBeSignificantHoweverClear) {
  // With five blocks of two queries, p is at least 2 / 32, since at least two of the 32 sign
  // patterns are as extreme; with six blocks it is at least 2 / 64.
  const Comparison five = compare_paired(all_equal_to(1, 10), true, 1);
  EXPECT_DOUBLE_EQ(five.p, 2.0 / 32);
  EXPECT_TRUE(std::isinf(five.detectable)) << "too few to detect anything";
  const Comparison six = compare_paired(all_equal_to(1, 12), true, 1);
  EXPECT_DOUBLE_EQ(six.p, 2.0 / 64);
  EXPECT_DOUBLE_EQ(six.detectable, 3.0 / 12);
  EXPECT_TRUE(std::isinf(compare_scenes(all_equal_to(1, 5), 5, 1).detectable));
}

TEST(ComparePaired, AnIntervalThatEndsAtZeroBesideALargePIsRecognized) {
  // Two of 40 queries differ, in the same direction: two of the four sign patterns are as far from
  // 0.
  std::vector<PairedDifference> two = all_equal_to(0, 40);
  two[3].difference = two[30].difference = 1;
  const Comparison c = compare_paired(two, true, 1);
  EXPECT_EQ(c.low, 0);
  EXPECT_GT(c.high, 0);
  EXPECT_DOUBLE_EQ(c.p, 0.5);
  EXPECT_TRUE(ends_at_zero(c));
  EXPECT_EQ(verdict(c), Verdict::kUndecided);
  EXPECT_FALSE(ends_at_zero(compare_paired(all_equal_to(0, 40), true, 1))) << "nothing differs";
  std::vector<PairedDifference> many = all_equal_to(1, 40);
  EXPECT_FALSE(ends_at_zero(compare_paired(many, true, 1)));
  for (std::size_t i = 0; i < 12; ++i) many[i].difference = -1;
  EXPECT_FALSE(ends_at_zero(compare_paired(many, true, 1)));
}

TEST(SignFlip, CountsThePatternsThatAreAsFarFromZero) {
  // 2 + 1 - 1 = 2: six of the eight sums +-2 +-1 +-1 are 2 or 4 away from zero.
  EXPECT_DOUBLE_EQ(sign_flip(std::vector<double>{2, 1, -1}, 1), 6.0 / 8);
  EXPECT_DOUBLE_EQ(sign_flip(std::vector<double>{0.1, 0.2, 0.3}, 1), 2.0 / 8);
  EXPECT_EQ(sign_flip(std::vector<double>{0, 0}, 1), 1.0);
  EXPECT_EQ(sign_flip({}, 1), 1.0);
}

TEST(SignFlip, DrawsAgreeWithTheNormalDistributionWherePatternsAreTooMany) {
  std::vector<double> sums(100, 1.0);
  for (std::size_t i = 0; i < 40; ++i) sums[2 * i] = -1.0;  // 60 against 40: two sigmas
  EXPECT_NEAR(sign_flip(sums, 1), std::erfc(1.9 / std::sqrt(2.0)),
              0.005);  // half a step closer, as continuity correction
  EXPECT_EQ(sign_flip(sums, 1), sign_flip(sums, 1));
  EXPECT_DOUBLE_EQ(sign_flip(std::vector<double>(100, 1.0), 1), 1.0 / 20001);
}

/// Simulates 500 comparisons without a difference. @returns the share that claims one at 5 %
/// @param carried  share of each query's noise that is carried over from the query before it
double false_claims(std::size_t n, double carried) {
  int claims = 0;
  constexpr int kTrials = 500;
  for (int trial = 0; trial < kTrials; ++trial) {
    const RandomStream noise = RandomStream(7).fork(static_cast<std::uint64_t>(trial));
    std::vector<PairedDifference> queries;
    for (std::size_t i = 0; i < n; ++i)
      queries.push_back({noise.normal(i + 1) + carried * noise.normal(i), true});
    Comparison c[] = {compare_paired(queries, false, 1, 300)};
    holm(c);
    claims += verdict(c[0]) == Verdict::kUndecided ? 0 : 1;
  }
  return static_cast<double>(claims) / kTrials;
}

TEST(ComparePaired, ClaimsWhereNothingDiffersStayNearFivePercent) {
  for (const std::size_t n : {6u, 20u, 74u})
    for (const double carried : {0.0, 0.5, 1.0})
      EXPECT_LE(false_claims(n, carried), 0.06) << n << " queries, " << carried;
}

TEST(ComparePaired, IsAFunctionOfItsSeed) {
  std::vector<PairedDifference> values;
  for (int i = 0; i < 60; ++i) values.push_back({0.1 * (i * 37 % 11 - 4), i % 7 != 0});
  EXPECT_EQ(compare_paired(values, false, 3).low, compare_paired(values, false, 3).low);
  EXPECT_NE(compare_paired(values, false, 3).p, 0);
}

TEST(Wilcoxon, AgreesWithCountingAllSigns) {
  // Five differences of the same sign: 2 of the 32 sign patterns are as extreme.
  EXPECT_DOUBLE_EQ(wilcoxon_signed_rank(std::vector<double>{1, 2, 3, 4, 5}), 2.0 / 32);
  // The positive ranks sum to 4 + 5 = 9 of 15: 13 subsets of {1 .. 5} have a sum of at most 6.
  EXPECT_DOUBLE_EQ(wilcoxon_signed_rank(std::vector<double>{-1, -2, -3, 4, 5}), 2 * 13.0 / 32);
  // Ties get the mean of their ranks, and zeros get no rank: ranks 1.5, 1.5, 3, all positive.
  EXPECT_DOUBLE_EQ(wilcoxon_signed_rank(std::vector<double>{1, 1, 2, 0}), 2.0 / 8);
  EXPECT_EQ(wilcoxon_signed_rank(std::vector<double>{0, 0}), 1.0);
  EXPECT_EQ(wilcoxon_signed_rank({}), 1.0);
  EXPECT_EQ(wilcoxon_signed_rank(std::vector<double>{-2, 2}), 1.0);
}

TEST(Wilcoxon, EqualSharesAreTiesHoweverTheyAreRounded) {
  // Differences of shares of 23 queries: 1, -1, 2, -1, 3 and 0 queries, each rounded differently.
  const auto share = [](int more, int fewer) { return more / 23.0 - fewer / 23.0; };
  const std::vector<double> shares = {share(3, 2),   share(7, 8),   share(22, 20),
                                      share(10, 11), share(20, 17), 1.0 / 3 - (1 - 2.0 / 3)};
  ASSERT_NE(std::abs(shares[0]), std::abs(shares[1])) << "these would be no test";
  EXPECT_EQ(wilcoxon_signed_rank(shares),
            wilcoxon_signed_rank(std::vector<double>{1, -1, 2, -1, 3, 0}));
}

TEST(Wilcoxon, NearsTheNormalDistributionForManyScenes) {
  std::vector<double> d;
  for (int i = 1; i <= 200; ++i) d.push_back(i % 2 == 0 && i % 14 != 0 ? -i : i);
  double positive = 0;
  for (const double x : d) positive += x > 0 ? x : 0;  // here, the ranks are |d|
  const double mean = 200 * 201 / 4.0, sd = std::sqrt(200 * 201 * 401 / 24.0);
  const double p = std::erfc((positive - 0.5 - mean) / sd / std::sqrt(2.0));
  EXPECT_NEAR(wilcoxon_signed_rank(d) / p, 1.0, 0.01);  // p = 0.083
}

TEST(CompareScenes, ScenesAreIndependentAndThoseWithoutAValueAreLeftOut) {
  std::vector<PairedDifference> scenes = all_equal_to(0.1, 20);
  for (std::size_t i = 0; i < 20; i += 2) scenes[i].difference = 0.3;
  const Comparison full = compare_scenes(scenes, 0, 1);
  EXPECT_NEAR(full.difference, 0.2, 1e-12);
  EXPECT_NEAR(full.high - full.low, 2 * 1.96 * 0.1 / std::sqrt(20.0), 0.02);
  EXPECT_LT(full.p, 1e-4);
  scenes.push_back({99, false});
  const Comparison same = compare_scenes(scenes, 0, 1);
  EXPECT_EQ(same.pairs, 20u);
  EXPECT_EQ(same.low, full.low);
}

// Six scenes with thirty queries each: since none of the 180 answers differs, the share of answers
// that differ is bounded by 3 / 180. If each scene counted as one answer, 3 / 6 would bound
// nothing.
TEST(CompareScenes, TheFloorOfWhatCanBeDetectedIsOfAnswersNotOfScenes) {
  const Comparison same = compare_scenes(all_equal_to(0, 6), 6 * 30, 1);
  EXPECT_DOUBLE_EQ(same.detectable, 3.0 / 180);
  std::vector<PairedDifference> scenes = all_equal_to(0, 6);
  for (std::size_t i = 0; i < 6; ++i) scenes[i].difference = i % 2 == 0 ? 0.1 : -0.1;
  const Comparison spread = compare_scenes(scenes, 6 * 30, 1);
  // One scene's difference has a standard deviation of 0.1 (as resampled), so the mean of six has
  // one of 0.1 / 6^0.5.
  EXPECT_NEAR(spread.detectable, 2.8 * 0.1 / std::sqrt(6.0), 0.005);
  EXPECT_EQ(compare_scenes(all_equal_to(0, 6), 0, 1).detectable, 0) << "no shares, no floor";
}

/// Scenes with `pairs` pairs each; all pairs of a scene have the same value.
std::vector<std::vector<PairedDifference>> scenes_of(const std::vector<double>& values,
                                                     std::size_t pairs) {
  std::vector<std::vector<PairedDifference>> scenes;
  for (const double value : values) scenes.push_back(all_equal_to(value, pairs));
  return scenes;
}

TEST(CompareClusters, EachQueryCountsTheSameAndScenesAreDrawnAsWholes) {
  // One large scene without a difference and nine small ones whose only query differs: 9 of 90 + 9
  // queries differ.
  std::vector<std::vector<PairedDifference>> scenes = scenes_of(std::vector<double>(9, 1.0), 1);
  scenes.push_back(all_equal_to(0, 90));
  scenes.back().resize(120);  // the added ones have no value and do not count
  const Comparison c = compare_clusters(scenes, true, 1);
  EXPECT_DOUBLE_EQ(c.difference, 9.0 / 99);
  EXPECT_EQ(c.pairs, 99u);
  EXPECT_EQ(c.clusters, 10u);
  EXPECT_DOUBLE_EQ(c.p, 2.0 / 512);  // nine scenes have the same sign, one has zero
  // Without the large scene, which 35 % of the resamplings leave out, all queries differ.
  EXPECT_DOUBLE_EQ(c.high, 1.0);
}

TEST(CompareClusters, QueriesOfOneSceneSayLittleMoreThanOne) {
  const std::vector<double> values{1, -1, 1, 0, 0, 1, -1, 0, 1, 0, 0, 1};
  const Comparison ten = compare_clusters(scenes_of(values, 10), false, 1),
                   one = compare_clusters(scenes_of(values, 1), false, 1);
  EXPECT_EQ(ten.pairs, 120u);
  EXPECT_EQ(ten.difference, one.difference);
  EXPECT_EQ(ten.low, one.low);
  EXPECT_EQ(ten.p, one.p);
}

TEST(CompareClusters, ScenesWithoutAnyPairDoNotCount) {
  // Three scenes decide nothing, no matter how many other scenes have no pair.
  std::vector<std::vector<PairedDifference>> scenes = scenes_of({1, 1, 1}, 2);
  scenes.emplace_back();
  scenes.emplace_back(5);  // queries for which only one of the two systems has a value
  const Comparison three = compare_clusters(scenes, true, 1);
  EXPECT_EQ(three.clusters, 3u);
  EXPECT_EQ(three.pairs, 6u);
  EXPECT_EQ(three.p, 1);
  EXPECT_TRUE(std::isinf(three.high) && std::isinf(three.detectable));

  // If there are enough scenes, those without a pair change neither p nor the smallest detectable
  // difference.
  scenes = scenes_of({1, 1, 0, 1, 1, 1}, 3);
  const Comparison six = compare_clusters(scenes, true, 1);
  scenes.insert(scenes.begin() + 2, 4, std::vector<PairedDifference>(2));
  const Comparison ten = compare_clusters(scenes, true, 1);
  EXPECT_EQ(ten.clusters, 6u);
  EXPECT_EQ(ten.p, six.p);
  EXPECT_EQ(ten.low, six.low);
  EXPECT_EQ(ten.high, six.high);
  EXPECT_EQ(ten.detectable, six.detectable);
}

TEST(CompareClusters, FewScenesDecideNothing) {
  EXPECT_TRUE(std::isinf(compare_clusters(scenes_of({1, 1, 1}, 50), true, 1).high));
  const Comparison five = compare_clusters(scenes_of({1, 1, 1, 1, 1}, 50), true, 1);
  EXPECT_DOUBLE_EQ(five.p, 2.0 / 32);
  EXPECT_TRUE(std::isinf(five.detectable));
  EXPECT_EQ(compare_clusters({}, true, 1).pairs, 0u);
  EXPECT_EQ(compare_clusters(scenes_of({1, 0}, 0), true, 1).p, 1);
}

// Scenes whose queries share half of their noise; the systems do not differ.
TEST(CompareClusters, ClaimsWhereNothingDiffersStayNearFivePercent) {
  for (const std::size_t count : {6u, 12u, 60u}) {
    int claims = 0;
    constexpr int kTrials = 500;
    for (int trial = 0; trial < kTrials; ++trial) {
      const RandomStream noise = RandomStream(11).fork(static_cast<std::uint64_t>(trial));
      std::vector<std::vector<PairedDifference>> scenes(count);
      for (std::size_t s = 0; s < count; ++s)
        for (std::size_t q = 0; q < 3 + s % 7; ++q)
          scenes[s].push_back({noise.normal(1000 * s) + noise.fork(s + 1).normal(q), true});
      claims += compare_clusters(scenes, false, 1, 100).p < 0.05 ? 1 : 0;
    }
    EXPECT_LE(static_cast<double>(claims) / kTrials, 0.07) << count << " scenes";
  }
}

TEST(Holm, CorrectsByRankAndStaysMonotone) {
  std::vector<Comparison> family(3, {.pairs = 9});
  family[0].p = 0.04;
  family[1].p = 0.01;
  family[2].p = 0.03;
  holm(family);
  EXPECT_DOUBLE_EQ(family[1].p_holm, 0.03);  // 3 * 0.01
  EXPECT_DOUBLE_EQ(family[2].p_holm, 0.06);  // 2 * 0.03
  EXPECT_DOUBLE_EQ(family[0].p_holm, 0.06);  // 1 * 0.04, but not below the previous one
}

TEST(Holm, CountsNeitherWhatHasNoPairsNorWhatStandsBesideTheFamily) {
  std::vector<Comparison> all(4, {.pairs = 9, .p = 0.01});
  all[1].pairs = 0;
  all[2].in_family = false;
  EXPECT_EQ(family_size(all), 2u);
  holm(all);
  EXPECT_DOUBLE_EQ(all[0].p_holm, 0.02);
  EXPECT_DOUBLE_EQ(all[3].p_holm, 0.02);
  for (const std::size_t i : {1u, 2u}) {
    all[i].low = all[i].high = all[i].difference = 1;
    EXPECT_EQ(all[i].p_holm, 1) << i;
    EXPECT_EQ(verdict(all[i]), Verdict::kUndecided) << i;
  }
}

}  // namespace
}  // namespace mh
