// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/retrieval.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

TEST(AveragePrecision, IsOneIfTheRelevantComeFirst) {
  EXPECT_DOUBLE_EQ(*average_precision({1, 1, 1, 0, 0}, 3), 1.0);
}

// If the only relevant item is at rank r, average precision is 1 / r.
TEST(AveragePrecision, OfOneAtRankRIsItsInverse) {
  for (std::size_t rank = 1; rank <= 20; ++rank) {
    Relevance ranked(20, 0);
    ranked[rank - 1] = 1;
    EXPECT_DOUBLE_EQ(*average_precision(ranked, 1), 1.0 / static_cast<double>(rank));
  }
}

// Every second item is relevant, starting with the second: precision is 1/2 at each of them.
TEST(AveragePrecision, OfEverySecondIsHalf) {
  EXPECT_DOUBLE_EQ(*average_precision({0, 1, 0, 1, 0, 1, 0, 1}, 4), 0.5);
}

TEST(AveragePrecision, CountsWhatIsNotInTheListAsZero) {
  EXPECT_DOUBLE_EQ(*average_precision({1, 1}, 4), 0.5);
  EXPECT_DOUBLE_EQ(*average_precision({}, 4), 0.0);
}

TEST(AveragePrecision, IsUnknownIfNothingIsRelevant) {
  EXPECT_FALSE(average_precision({0, 0}, 0).has_value());
  EXPECT_FALSE(recall_at(1, {0, 0}, 0).has_value());
}

TEST(PrecisionAndRecall, CountTheFirstK) {
  const Relevance ranked{1, 0, 1, 1, 0};
  EXPECT_DOUBLE_EQ(precision_at(1, ranked), 1.0);
  EXPECT_DOUBLE_EQ(precision_at(4, ranked), 0.75);
  EXPECT_DOUBLE_EQ(precision_at(10, ranked), 0.3) << "beyond the list's end nothing is relevant";
  EXPECT_DOUBLE_EQ(*recall_at(1, ranked, 6), 1.0 / 6);
  EXPECT_DOUBLE_EQ(*recall_at(10, ranked, 6), 0.5);
}

}  // namespace
}  // namespace mh
