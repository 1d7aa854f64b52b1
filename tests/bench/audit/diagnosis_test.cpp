// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

/// Frames of random factors, of which those with fewer than 80 keypoints fail.
std::vector<JudgedFrame> frames() {
  std::vector<JudgedFrame> all;
  const RandomStream draws(3);
  for (std::size_t i = 0; i < 1000; ++i) {
    JudgedFrame frame{.run = "one", .frame = i};
    const RandomStream of_frame = draws.fork(i);
    for (std::size_t f = 0; f < kFactors; ++f) frame.factors[f] = 100 * of_frame.uniform(f);
    double& keypoints = frame.factors[static_cast<std::size_t>(Factor::kKeypoints)];
    keypoints = 1000 * of_frame.uniform(99);
    // A dark frame has few keypoints, and is dark for other reasons, too.
    double& brightness = frame.factors[static_cast<std::size_t>(Factor::kBrightness)];
    brightness = 0.1 * keypoints + 60 * of_frame.uniform(98);
    frame.failed = keypoints < 80;
    all.push_back(frame);
  }
  return all;
}

TEST(Diagnosis, RanksFirstWhatBreaksTheSystem) {
  const std::vector<RelativeRisk> ranked = rank_factors(frames());
  ASSERT_EQ(ranked.size(), kFactors);
  EXPECT_EQ(ranked[0].factor, Factor::kKeypoints);
  EXPECT_NEAR(ranked[0].limit, 80, 25);
  EXPECT_GT(ranked[0].low, 20);
  EXPECT_EQ(ranked[1].factor, Factor::kBrightness) << "comes with it";
  for (std::size_t k = 2; k < kFactors; ++k) EXPECT_LT(ranked[k].low, 1.6);
}

TEST(Diagnosis, SaysNothingWhereNothingOrEverythingFailed) {
  std::vector<JudgedFrame> all = frames();
  for (JudgedFrame& frame : all) frame.failed = false;
  EXPECT_TRUE(rank_factors(all).empty());
  for (JudgedFrame& frame : all) frame.failed = true;
  EXPECT_TRUE(rank_factors(all).empty());
}

TEST(Diagnosis, IsASentenceForEachFactorAndNamesTheFrames) {
  const std::string text = diagnosis_text({{"mine, level pepper", frames(), {}}});
  EXPECT_THAT(text, testing::HasSubstr("mine, level pepper: "));
  EXPECT_THAT(text, testing::HasSubstr("  keypoints below "));
  EXPECT_THAT(text, testing::HasSubstr("times as often ("));
  EXPECT_THAT(text, testing::HasSubstr("  frames: one: "));
  EXPECT_THAT(text, testing::HasSubstr("Observed, not caused"));
}

}  // namespace
}  // namespace mh
