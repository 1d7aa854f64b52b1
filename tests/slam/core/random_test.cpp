// SPDX-License-Identifier: Apache-2.0
#include "slam/core/random.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

// 100,000 samples: the standard error of the mean is 0.0009 (uniform) and 0.0032 (normal);
// deviations of five standard errors do not happen by chance, and the samples are fixed anyway.
constexpr int kDraws = 100000;

TEST(RandomStream, UniformAndNormalHaveTheirMoments) {
  const RandomStream stream = RandomStream(7).fork(3);
  double uniform = 0, normal = 0, squared = 0;
  for (int i = 0; i < kDraws; ++i) {
    uniform += stream.uniform(i);
    normal += stream.normal(i);
    squared += stream.normal(i) * stream.normal(i);
  }
  EXPECT_NEAR(uniform / kDraws, 0.5, 0.005);
  EXPECT_NEAR(normal / kDraws, 0.0, 0.016);
  EXPECT_NEAR(squared / kDraws, 1.0, 0.025);
}

TEST(RandomStream, StreamsDifferByEveryKey) {
  const RandomStream a(1);
  EXPECT_NE(a.fork(1).bits(0), a.fork(2).bits(0));
  EXPECT_NE(a.fork(1).fork(2).bits(0), a.fork(2).fork(1).bits(0));
  EXPECT_NE(RandomStream(1).bits(0), RandomStream(2).bits(0));
  EXPECT_EQ(a.fork(1).bits(5), RandomStream(1).fork(1).bits(5));
}

TEST(RandomStream, BelowCoversItsRangeEvenly) {
  int count[7] = {};
  for (int i = 0; i < 7000; ++i) ++count[RandomStream(5).below(i, 7)];
  for (const int c : count) EXPECT_NEAR(c, 1000, 150);
}

}  // namespace
}  // namespace mh
