// SPDX-License-Identifier: Apache-2.0
#include "slam/core/legible.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

TEST(Legible, WhatCanBeReadStaysAsItIs) {
  for (const char* text : {"", "chair_01", "Stühle", "椅子", "🪑", "a b~"}) {
    EXPECT_EQ(legible(text), text);
    EXPECT_TRUE(is_legible(text));
  }
}

TEST(Legible, WhatATerminalObeysIsAQuestionMark) {
  EXPECT_EQ(legible("a\x1b[31m\r\n\tb\x7f"), "a?[31m???b?");
  EXPECT_EQ(legible("a\xc2\x9b"
                    "b"),
            "a??b");  // one byte's escape, as UTF-8
  EXPECT_EQ(legible("a\xe2\x80\xae"
                    "b"),
            "a???b");  // from right to left
  EXPECT_EQ(legible(std::string("a\0b", 3)), "a?b");
}

TEST(Legible, WhatIsNoUtf8IsAQuestionMarkForEachByte) {
  EXPECT_EQ(legible("\xff\xfe\x80x"), "???x");
  EXPECT_EQ(legible("\xc3"), "?");                      // truncated
  EXPECT_EQ(legible("\xc0\xaf\xe0\x80\xaf"), "?????");  // longer than need be
  EXPECT_EQ(legible("\xed\xa0\x80"), "???");            // half a pair of UTF-16
  EXPECT_EQ(legible("\xf4\x90\x80\x80"), "????");       // beyond Unicode
  EXPECT_EQ(legible("\xc3x"), "?x");
  EXPECT_FALSE(is_legible("\xff"));
}

}  // namespace
}  // namespace mh
