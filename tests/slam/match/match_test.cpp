// SPDX-License-Identifier: Apache-2.0
#include "slam/match/match.hpp"

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

/// Descriptor `base` with the first n bits flipped.
Descriptor flipped(Descriptor base, int n) {
  for (int i = 0; i < n; ++i) base[static_cast<std::size_t>(i / 64)] ^= 1ULL << (i % 64);
  return base;
}

struct Frame {
  Features features;
  void add(float u, float v, Descriptor d, ClassId label = kVoid, int octave = 0,
           float angle = 1.0F) {
    features.keypoints.push_back(
        {.u_px = u, .v_px = v, .angle_rad = angle, .octave = octave, .label = label});
    features.descriptors.push_back(d);
  }
};

const Descriptor kBase{0x123456789abcdefULL, 0xfedcba987654321ULL, 0x0f0f0f0f0f0f0f0fULL, 42};

TEST(MatchByProjection, PenalizesDisagreeingLabelsAndCounts) {
  Frame frame;
  frame.add(100, 100, flipped(kBase, 20), ClassId{5});  // nearer, but a chair
  frame.add(103, 100, flipped(kBase, 25), ClassId{7});  // a table, like the target
  const FeatureGrid grid(frame.features.keypoints, Camera{});
  const std::vector<std::uint8_t> taken(2, 0);
  const ProjectionTarget target{.u_px = 101,
                                .v_px = 100,
                                .radius_px = 10,
                                .min_octave = 0,
                                .max_octave = 0,
                                .descriptor = &kBase,
                                .label = ClassId{7}};
  const auto match = [&](double xi, MatcherCounts& counts) {
    const SemanticConfig config{.xi = xi};
    return match_by_projection({&target, 1}, frame.features, grid, taken, {},
                               SemanticMatcher(config, counts))[0];
  };
  MatcherCounts plain, semantic;
  EXPECT_EQ(match(1.0, plain), 0);
  EXPECT_EQ(match(1.5, semantic), 1);  // 20 * 1.5 = 30 > 25
  EXPECT_EQ(semantic.compared, 2);
  EXPECT_EQ(semantic.penalized, 1);
  EXPECT_EQ(semantic.rejected_by_xi, 0);
}

TEST(MatchByProjection, LogsWhatBecameOfEachPair) {
  Frame frame;
  frame.add(100, 100, flipped(kBase, 10));
  frame.add(200, 100, flipped(kBase, 70));
  frame.add(300, 100, flipped(kBase, 20));
  frame.add(303, 100, flipped(kBase, 22));
  const FeatureGrid grid(frame.features.keypoints, Camera{});
  const std::vector<std::uint8_t> taken(4, 0);
  const Descriptor nearer = flipped(kBase, 5);
  const auto target = [](float u_px, const Descriptor& descriptor) {
    return ProjectionTarget{.u_px = u_px, .v_px = 100, .radius_px = 10, .descriptor = &descriptor};
  };
  const std::vector<ProjectionTarget> targets{target(100, kBase), target(101, nearer),
                                              target(200, kBase), target(301, kBase),
                                              target(500, kBase)};
  MatcherCounts counts;
  GateLog log{{7, 7, MatchGate::kKept}};  // from an earlier search
  const auto match =
      match_by_projection(targets, frame.features, grid, taken, {.max_distance = 50, .ratio = 0.8F},
                          SemanticMatcher(SemanticConfig{}, counts, &log));
  EXPECT_EQ(match, (std::vector<std::int32_t>{-1, 0, -1, -1, -1}));
  std::vector<std::pair<std::uint32_t, MatchGate>> gates;
  for (const GatedPair& pair : log) gates.emplace_back(pair.asked, pair.gate);
  using enum MatchGate;
  EXPECT_EQ(gates, (std::vector<std::pair<std::uint32_t, MatchGate>>{
                       {7, kKept}, {0, kTaken}, {1, kKept}, {2, kThreshold}, {3, kRatio}}));
}

TEST(SemanticMatcher, CountsThresholdAndRatioEffectsApart) {
  MatcherCounts counts;
  SemanticMatcher matcher(SemanticConfig{.xi = 2.0}, counts);
  // The penalty increases the best distance from 30 to 60, above the gate of 50.
  SemanticMatcher::Best best;
  best.offer(0, matcher({flipped(kBase, 30), ClassId{1}}, {kBase, ClassId{2}}), 0);
  EXPECT_FALSE(matcher.accept(best, 50, 0.75F));
  EXPECT_EQ(counts.rejected_by_xi, 1);
  // Best 40, second best 44 -> 88: the ratio test passes only because the second was increased.
  best = {};
  best.offer(0, matcher({flipped(kBase, 40), ClassId{1}}, {kBase, ClassId{1}}), 0);
  best.offer(1, matcher({flipped(kBase, 44), ClassId{1}}, {kBase, ClassId{2}}), 0);
  EXPECT_TRUE(matcher.accept(best, 50, 0.75F));
  EXPECT_EQ(counts.ratio_helped, 1);
}

TEST(MatchByProjection, AFeatureGoesToTheNearestTarget) {
  Frame frame;
  frame.add(100, 100, kBase);
  const FeatureGrid grid(frame.features.keypoints, Camera{});
  const Descriptor far = flipped(kBase, 20), near = flipped(kBase, 5);
  const std::vector<ProjectionTarget> targets{
      {.u_px = 100, .v_px = 100, .radius_px = 5, .descriptor = &far},
      {.u_px = 102, .v_px = 100, .radius_px = 5, .descriptor = &near},
      {.u_px = 101, .v_px = 100, .radius_px = 5, .descriptor = &far}};
  MatcherCounts counts;
  const auto match =
      match_by_projection(targets, frame.features, grid, std::vector<std::uint8_t>(1, 0), {},
                          SemanticMatcher(SemanticConfig{}, counts));
  EXPECT_EQ(match, (std::vector<std::int32_t>{-1, 0, -1}));
}

TEST(MatchByProjection, RespectsRadiusOctaveAndTaken) {
  Frame frame;
  frame.add(100, 100, kBase, kVoid, 3);
  frame.add(140, 100, kBase, kVoid, 0);
  frame.add(101, 101, kBase, kVoid, 0);
  const FeatureGrid grid(frame.features.keypoints, Camera{});
  const ProjectionTarget target{.u_px = 100,
                                .v_px = 100,
                                .radius_px = 10,
                                .min_octave = 0,
                                .max_octave = 1,
                                .descriptor = &kBase};
  MatcherCounts counts;
  const SemanticMatcher matcher(SemanticConfig{}, counts);
  EXPECT_EQ(match_by_projection({&target, 1}, frame.features, grid,
                                std::vector<std::uint8_t>{0, 0, 0}, {}, matcher)[0],
            2);
  EXPECT_EQ(match_by_projection({&target, 1}, frame.features, grid,
                                std::vector<std::uint8_t>{0, 0, 1}, {}, matcher)[0],
            -1);
}

TEST(FeatureGrid, FindsWhatAScanFinds) {
  std::vector<Keypoint> keypoints;
  const RandomStream random(3);
  for (int i = 0; i < 500; ++i)
    keypoints.push_back({.u_px = static_cast<float>(random.uniform(2 * i, 0, 639)),
                         .v_px = static_cast<float>(random.uniform(2 * i + 1, 0, 479))});
  const FeatureGrid grid(keypoints, Camera{});
  for (const float radius : {3.0F, 40.0F, 900.0F})
    for (const auto& [u, v] : {std::pair{5.0F, 470.0F}, {320.0F, 240.0F}, {-10.0F, 900.0F}}) {
      std::vector<std::uint32_t> found, scanned;
      const auto within = [&, u = u, v = v](std::uint32_t i) {
        return std::abs(keypoints[i].u_px - u) <= radius &&
               std::abs(keypoints[i].v_px - v) <= radius;
      };
      grid.for_each_near(u, v, radius, [&](const FeatureGrid::Entry& k) {
        if (within(k.index)) found.push_back(k.index);
      });
      for (std::uint32_t i = 0; i < keypoints.size(); ++i)
        if (within(i)) scanned.push_back(i);
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, scanned);
    }
}

TEST(MatchByWords, MatchesWithinNodesOnceAndByDominantRotation) {
  Frame a, b;
  WordIndex words_a, words_b;
  const RandomStream random(9);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const Descriptor d{random.bits(4 * i), random.bits(4 * i + 1), random.bits(4 * i + 2),
                       random.bits(4 * i + 3)};
    a.add(0, 0, d, kVoid, 0, 1.0F);
    // All rotate by 0.5 rad except the last, which rotates by 3.
    b.add(0, 0, flipped(d, 6), kVoid, 0, i == 39 ? 4.0F : 1.5F);
    words_a.by_node.emplace_back(i % 4, i);
    words_b.by_node.emplace_back(i == 7 ? 9 : i % 4, i);  // feature 7 is under a different node
  }
  std::sort(words_a.by_node.begin(), words_a.by_node.end());
  std::sort(words_b.by_node.begin(), words_b.by_node.end());
  MatcherCounts counts;
  const std::vector<std::uint8_t> all(40, 1);
  const auto matches = match_by_words({a.features, words_a, all}, {b.features, words_b, all},
                                      {50, 0.75F}, SemanticMatcher(SemanticConfig{}, counts));
  EXPECT_EQ(
      matches.size(),
      38U);  // 40 without the one under a different node and the one with a different rotation
  for (const FeatureMatch& m : matches) {
    EXPECT_EQ(m.a, m.b);
    EXPECT_NE(m.a, 7U);
    EXPECT_NE(m.a, 39U);
  }
}

/// Number of matches of 40 features that all rotate by 0.5 rad, except the last, which rotates from
/// one given angle to another.
std::size_t matches_with_last_turn(float from_rad, float to_rad) {
  Frame a, b;
  WordIndex words;
  const RandomStream random(9);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const Descriptor d{random.bits(4 * i), random.bits(4 * i + 1), random.bits(4 * i + 2),
                       random.bits(4 * i + 3)};
    a.add(0, 0, d, kVoid, 0, i == 39 ? from_rad : 1.0F);
    b.add(0, 0, d, kVoid, 0, i == 39 ? to_rad : 1.5F);
    words.by_node.emplace_back(i, i);
  }
  MatcherCounts counts;
  const std::vector<std::uint8_t> all(40, 1);
  return match_by_words({a.features, words, all}, {b.features, words, all}, {50, 0.75F},
                        SemanticMatcher(SemanticConfig{}, counts))
      .size();
}

TEST(MatchByWords, ATurnIsTheSameAcrossTheFullCircle) {
  constexpr float kTurn = 6.2831853F;
  EXPECT_EQ(matches_with_last_turn(6.0F, 6.5F - kTurn), 40U);
  EXPECT_EQ(matches_with_last_turn(-0.2F, 0.3F), 40U);
  EXPECT_EQ(matches_with_last_turn(3.0F, 2.5F), 39U) << "0.5 rad the other way";
}

TEST(MatchByWords, LabelsThatDisagreePayXi) {
  Frame a, b;
  WordIndex words;
  constexpr ClassId kChair = 5, kTable = 7;
  const RandomStream random(9);
  for (std::uint32_t i = 0; i < 12; ++i) {
    const Descriptor d{random.bits(4 * i), random.bits(4 * i + 1), random.bits(4 * i + 2),
                       random.bits(4 * i + 3)};
    a.add(0, 0, d, kChair, 0, 0.0F);
    b.add(0, 0, flipped(d, 40), i % 3 == 0 ? kTable : i % 3 == 1 ? kChair : kVoid, 0, 0.0F);
    words.by_node.emplace_back(i, i);  // each pair has its own node
  }
  MatcherCounts counts;
  const std::vector<std::uint8_t> all(12, 1);
  const auto matches =
      match_by_words({a.features, words, all}, {b.features, words, all}, {50, 0.75F},
                     SemanticMatcher(SemanticConfig{.xi = 1.5}, counts));
  EXPECT_EQ(matches.size(), 8U);  // 40 bits are below 50, 1.5 times 40 are not
  for (const FeatureMatch& m : matches) EXPECT_NE(m.b % 3, 0U);
  EXPECT_EQ(counts.compared, 12);
  EXPECT_EQ(counts.penalized, 4);
  EXPECT_EQ(counts.rejected_by_xi, 4);
}

}  // namespace
}  // namespace mh
