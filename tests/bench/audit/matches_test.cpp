// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/matches.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

constexpr ClassId kChair = 5, kTable = 7;

MatchDecision decision(bool with_xi, std::uint32_t asked, std::uint32_t feature, MatchGate gate) {
  return {.matcher = Matcher::kRelocalizationWords,
          .with_xi = with_xi,
          .gate = gate,
          .feature = feature,
          .landmark = LandmarkId{asked},
          .keyframe = KeyframeId{0},
          .other_feature = asked};
}

/// Feature i shows the same point of the scene as map point i. Map points with an odd number are
/// tables; other map points and all features are chairs. Points from number 100 on are at a border,
/// and those from 200 on are unknown: they show nothing.
std::pair<MatchEnd, MatchEnd> ends_of(const MatchDecision& d) {
  const auto end = [](std::uint32_t i, ClassId label) {
    MatchEnd made{TruePoint{{static_cast<double>(i), 0, 2}, 2.0, i >= 100}, label};
    if (i >= 200) made.point.reset();
    return made;
  };
  return {end(d.feature, kChair), end(d.other_feature, d.other_feature % 2 == 1 ? kTable : kChair)};
}

StageMatches of_words(const DecisionTrace& decisions, VoidPolicy policy = VoidPolicy::kUnknown) {
  return audit_matches(decisions, ends_of, policy)[0];
}

TEST(AuditMatches, PrecisionAndRecallAreOfPairsByGate) {
  using enum MatchGate;
  const StageMatches m = of_words({decision(true, 0, 0, kKept), decision(true, 2, 2, kKept),
                                   decision(true, 4, 5, kKept), decision(true, 6, 6, kRatio),
                                   decision(true, 8, 9, kThreshold)});
  EXPECT_EQ(m.with_xi.kept_right(), 2);
  EXPECT_EQ(m.with_xi.kept_wrong(), 1);
  EXPECT_DOUBLE_EQ(*m.with_xi.precision(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(*m.with_xi.recall(), 2.0 / 3) << "one right pair fell to the ratio test";
  EXPECT_EQ(m.with_xi.wrong[static_cast<std::size_t>(kThreshold)], 1);
  EXPECT_FALSE(m.without_xi.precision().has_value());
}

TEST(AuditMatches, WhatXiCostIsNamedByGateAndByLabel) {
  using enum MatchGate;
  const DecisionTrace decisions{decision(true, 1, 1, kThreshold), decision(true, 3, 3, kRatio),
                                decision(true, 101, 101, kThreshold), decision(true, 6, 6, kTaken),
                                decision(true, 9, 2, kThreshold), decision(true, 8, 8, kKept),
                                // at xi = 1, all but one of these matches are kept
                                decision(false, 1, 1, kKept), decision(false, 3, 3, kKept),
                                decision(false, 101, 101, kKept), decision(false, 6, 6, kKept),
                                decision(false, 9, 2, kKept), decision(false, 8, 8, kRatio)};
  const StageMatches m = of_words(decisions);
  EXPECT_EQ(m.xi.lost_to_threshold, 2);
  EXPECT_EQ(m.xi.lost_to_ratio, 1);
  EXPECT_EQ(m.xi.lost_to_another, 1);
  EXPECT_EQ(m.xi.right_lost(), 4);
  EXPECT_EQ(m.xi.lost_by_label_error, 2) << "the labels of 6 agree: no label is at fault";
  EXPECT_EQ(m.xi.lost_at_border, 1);
  EXPECT_EQ(m.xi.lost_by_void, 0);
  EXPECT_EQ(m.xi.wrong_removed, 1);
  EXPECT_EQ(m.xi.right_gained, 1);
  EXPECT_EQ(m.xi.right_differ, 3);
  EXPECT_EQ(m.xi.wrong_differ, 1);
}

TEST(AuditMatches, AnotherNearestFeatureIsAnotherPair) {
  using enum MatchGate;
  // With xi, a wrong feature is nearest to point 1, and its match is kept.
  const StageMatches m = of_words({decision(true, 1, 4, kKept), decision(false, 1, 1, kKept)});
  EXPECT_EQ(m.xi.lost_to_another, 1);
  EXPECT_EQ(m.xi.wrong_gained, 1);
}

TEST(AuditMatches, SearchesAreComparedEachWithItself) {
  using enum MatchGate;
  // The same point is looked for in two candidates; only the first search loses it.
  const StageMatches m = of_words({decision(true, 1, 1, kRatio), decision(false, 1, 1, kKept),
                                   decision(true, 1, 1, kKept), decision(false, 1, 1, kKept)});
  EXPECT_EQ(m.xi.lost_to_ratio, 1);
  EXPECT_EQ(m.with_xi.kept_right(), 1);
  EXPECT_EQ(m.without_xi.kept_right(), 2);
}

TEST(AuditMatches, PairsOfUnknownTruthAreLeftOut) {
  const StageMatches m = of_words({decision(true, 200, 200, MatchGate::kKept)});
  EXPECT_FALSE(m.with_xi.precision().has_value());
}

TEST(AuditMatches, OtherStagesOfAStepAreLeftOut) {
  MatchDecision tracked = decision(true, 0, 0, MatchGate::kKept);
  tracked.matcher = Matcher::kReferenceKeyframe;
  for (const StageMatches& m : audit_matches({tracked}, ends_of, VoidPolicy::kUnknown))
    EXPECT_EQ(m.with_xi.kept_right(), 0);
}

}  // namespace
}  // namespace mh
