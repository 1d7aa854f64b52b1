// SPDX-License-Identifier: Apache-2.0
#include "slam/io/suggest.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

const std::vector<std::string> kLevels = {"handheld", "ideal", "pepper"};

TEST(NearestWord, OneEditOfAnyKindIsForgiven) {
  for (const char* word : {"peppe", "peppers", "pepler", "pepepr", "Pepper", "pep-per"})
    EXPECT_EQ(nearest_word(word, kLevels), "pepper") << word;
  EXPECT_EQ(nearest_word("hand held", kLevels), "handheld");
}

TEST(NearestWord, AWordOfItsOwnIsNoSlip) {
  for (const char* word : {"", "x", "robot", "peck"})
    EXPECT_EQ(nearest_word(word, kLevels), std::nullopt) << word;
  EXPECT_EQ(nearest_word("c", {"a"}), std::nullopt)
      << "a letter for a letter has nothing in common";
}

TEST(NearestWord, TheNearestWinsAndTheFirstOfEquals) {
  EXPECT_EQ(nearest_word("tabel", {"cable", "table"}), "table");
  EXPECT_EQ(nearest_word("bat", {"bad", "bar"}), "bad");
}

TEST(Hint, NamesTheNearestAndAllThatIsValid) {
  EXPECT_EQ(hint("peper", kLevels), "; did you mean 'pepper'? There are: handheld, ideal, pepper");
  EXPECT_EQ(hint("dark", kLevels), "; there are: handheld, ideal, pepper");
  EXPECT_EQ(hint("dark", {}), "");
  const std::vector<std::string> many(50, "same");
  EXPECT_TRUE(hint("same", many, "here").ends_with(", same and 10 more (here)"));
}

}  // namespace
}  // namespace mh
