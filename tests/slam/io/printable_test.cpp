// SPDX-License-Identifier: Apache-2.0
#include "slam/io/printable.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

TEST(Legible, WhatCanBeReadStaysAsItIs) {
  for (const char* text : {"", "chair_01", "Stühle", "椅子", "🪑", "a b~"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_TRUE(is_legible(text));
  }
}

TEST(Legible, WhatATerminalObeysIsAQuestionMark) {
  EXPECT_EQ(printable("a\x1b[31m\r\n\tb\x7f"), "a?[31m???b?");
  EXPECT_EQ(printable("a\xc2\x9b"
                      "b"),
            "a??b");  // an escape sequence in one character, as UTF-8
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b"),
            "a???b");  // the override for right-to-left text
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
}

TEST(Legible, WhatIsNoUtf8IsAQuestionMarkForEachByte) {
  EXPECT_EQ(printable("\xff\xfe\x80x"), "???x");
  EXPECT_EQ(printable("\xc3"), "?");                      // truncated
  EXPECT_EQ(printable("\xc0\xaf\xe0\x80\xaf"), "?????");  // longer than necessary
  EXPECT_EQ(printable("\xed\xa0\x80"), "???");            // half of a UTF-16 surrogate pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "????");       // beyond Unicode
  EXPECT_EQ(printable("\xc3x"), "?x");
  EXPECT_FALSE(is_legible("\xff"));
}

}  // namespace
}  // namespace mh
