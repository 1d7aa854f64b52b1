// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/epnp.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/slam/optimize/synthetic.hpp"

namespace mh {
namespace {

using testing::distance_m;
using testing::make_outliers;
using testing::observe;
using testing::true_pose;

const Camera kEpnpCamera{};

/// Exact observations of pixels only; the first `wrong` of them are false.
std::vector<PoseObservation> pixels(int count, int wrong, std::uint64_t seed) {
  auto observations = observe(count, true_pose(), kEpnpCamera, RandomStream(seed).fork(0));
  make_outliers(observations, wrong, kEpnpCamera, RandomStream(seed).fork(1));
  for (PoseObservation& o : observations) o.disparity_px = -1;
  return observations;
}

/// The estimates offered until one is accepted.
std::vector<PoseEstimate> offered(const std::vector<PoseObservation>& observations,
                                  std::uint64_t seed, bool accept) {
  std::vector<PoseEstimate> all;
  for_each_epnp_consensus(observations, kEpnpCamera, {}, {}, RandomStream(seed),
                          [&](const PoseEstimate& estimate) {
                            all.push_back(estimate);
                            return accept;
                          });
  return all;
}

TEST(EpnpConsensus, OfExactPixelsIsTheExactPose) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto found = offered(pixels(60, 0, seed), seed, true);
    ASSERT_EQ(found.size(), 1U) << seed;
    EXPECT_EQ(found[0].inlier_count, 60) << seed;
    EXPECT_LT(distance_m(found[0].camera_from_world, true_pose()), 1e-6) << seed;
  }
}

// 35 samples of four where 60 % are true: 1 - 0.87^35 = 99 %.
TEST(EpnpConsensus, FindsThePoseWhereMoreThanHalfAreTrue) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto all = offered(pixels(60, 24, seed), seed, true);
    if (all.empty()) continue;
    ++found;
    EXPECT_EQ(all[0].inlier_count, 36) << seed;
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(all[0].inlier[i], 0) << seed;
    EXPECT_LT(distance_m(all[0].camera_from_world, true_pose()), 1e-6) << seed;
  }
  EXPECT_GE(found, 37);
}

TEST(EpnpConsensus, OffersNothingBelowHalf) {
  for (std::uint64_t seed = 0; seed < 40; ++seed)
    EXPECT_TRUE(offered(pixels(60, 31, seed), seed, true).empty()) << seed;
  EXPECT_TRUE(offered(pixels(9, 0, 1), 1, true).empty()) << "fewer than ransac.min_inliers";
  EXPECT_TRUE(offered({}, 1, true).empty());
}

// Exactly half are true: no refined consensus is larger than what is needed, so only the largest
// one is offered, unrefined, at the end.
TEST(EpnpConsensus, TheLargestIsOfferedAtTheEnd) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto all = offered(pixels(40, 20, seed), seed, false);
    ASSERT_LE(all.size(), 1U);
    for (const PoseEstimate& last : all) EXPECT_EQ(last.inlier_count, 20);
    found += static_cast<int>(all.size());
  }
  EXPECT_GT(found, 10);
}

TEST(EpnpConsensus, DependsOnItsStreamAlone) {
  const auto observations = pixels(60, 20, 5);
  const auto a = offered(observations, 7, false), b = offered(observations, 7, false);
  ASSERT_GT(a.size(), 1U);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].inlier, b[i].inlier);
}

TEST(EpnpConsensus, PointsOfOnePlaceAreRefusedNotFatal) {
  auto observations = pixels(20, 0, 2);
  for (PoseObservation& o : observations) o = observations.front();
  offered(observations, 1, false);
}

}  // namespace
}  // namespace mh
