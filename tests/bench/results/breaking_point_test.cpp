// SPDX-License-Identifier: Apache-2.0
#include "bench/results/breaking_point.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mh {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

TEST(NeverRising, PoolsWhatRises) {
  EXPECT_THAT(never_rising(std::vector{1.0, 0.5, 0.7, 0.2}),
              ElementsAre(1.0, DoubleEq(0.6), DoubleEq(0.6), 0.2));
  EXPECT_THAT(never_rising(std::vector{0.0, 0.3, 0.6}),
              ElementsAre(DoubleEq(0.3), DoubleEq(0.3), DoubleEq(0.3)));
  EXPECT_THAT(never_rising(std::vector{0.9, 0.4}), ElementsAre(0.9, 0.4));
}

TEST(Crossing, IsInterpolated) {
  const std::vector at{0.0, 0.5, 1.0};
  EXPECT_EQ(crossing(at, std::vector{1.0, 0.8, 0.6}, 0.5), std::nullopt);
  EXPECT_DOUBLE_EQ(*crossing(at, std::vector{1.0, 0.8, 0.3}, 0.5), 0.8);
  EXPECT_DOUBLE_EQ(*crossing(at, std::vector{0.4, 0.3, 0.2}, 0.5), 0.0);
}

/// Six rooms of 10 questions, all with the same share of right answers at each dose.
std::vector<DoseResult> equal_rooms(const std::vector<std::pair<double, double>>& curve) {
  std::vector<DoseResult> doses;
  for (const auto& [at, share] : curve)
    doses.push_back({at, std::vector(6, 10 * share), std::vector(6, 10.0)});
  return doses;
}

TEST(BreakingPoint, LiesWhereHalfIsLeftAndItsIntervalCoversTheBracket) {
  const BreakingPoint point =
      breaking_point(equal_rooms({{0, 0.8}, {0.5, 0.6}, {0.75, 0.2}, {1, 0}}), 0.5, 0);
  EXPECT_EQ(point.breaks, Breaks::kAtDose);
  EXPECT_DOUBLE_EQ(point.at, 0.625);  // 0.4 is left
  EXPECT_EQ(point.low, 0.5);
  EXPECT_EQ(point.high, 0.75);
}

TEST(BreakingPoint, IsNoneForASystemThatStandsOrThatFailsWithoutAFault) {
  EXPECT_EQ(breaking_point(equal_rooms({{0, 0.8}, {1, 0.5}}), 0.5, 0).breaks, Breaks::kNever);
  EXPECT_EQ(breaking_point(equal_rooms({{0, 0.0}}), 0.5, 0).breaks, Breaks::kBeforeAnyDose);
}

TEST(BreakingPoint, RoomsThatDifferWidenTheInterval) {
  // Half of the rooms break at a quarter of the range, the others at three quarters.
  std::vector<DoseResult> doses;
  for (const double at : {0.0, 0.2, 0.3, 0.5, 0.7, 0.8, 1.0}) {
    DoseResult dose{.at = at};
    for (int room = 0; room < 6; ++room) {
      dose.right.push_back(at < (room < 3 ? 0.25 : 0.75) ? 10 : 0);
      dose.asked.push_back(10);
    }
    doses.push_back(dose);
  }
  const BreakingPoint point = breaking_point(doses, 0.6, 1);
  EXPECT_LT(point.low, 0.31);
  EXPECT_GT(point.high, 0.7);
  const auto ratio = compare_breaking(doses, doses, 0.6, 1);
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(ratio->ratio, 1, 1e-12);
  EXPECT_GT(ratio->low, 0.3) << "the same rooms are drawn for both: only the brackets are open";
  EXPECT_LT(ratio->high, 3);
}

TEST(CompareBreaking, IsTheRatioOfTheDoses) {
  const auto ratio = compare_breaking(equal_rooms({{0, 1}, {0.4, 1}, {0.4001, 0}}),
                                      equal_rooms({{0, 1}, {0.2, 1}, {0.2001, 0}}), 0.5, 0);
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(ratio->ratio, 2, 0.01);
  EXPECT_FALSE(
      compare_breaking(equal_rooms({{0, 1}, {1, 1}}), equal_rooms({{0, 1}, {1, 0}}), 0.5, 0));
}

}  // namespace
}  // namespace mh
