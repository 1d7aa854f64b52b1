// SPDX-License-Identifier: Apache-2.0
#include "bench/run/run.hpp"

#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace mh {
namespace {

TEST(Shard, IsOneOfSoMany) {
  const auto read = [](const char* text) {
    const Shard shard = parse_shard(text);
    return std::pair(shard.index, shard.of);
  };
  EXPECT_EQ(read("1/1"), std::pair(std::size_t{1}, std::size_t{1}));
  EXPECT_EQ(read("2/3"), std::pair(std::size_t{2}, std::size_t{3}));
  EXPECT_EQ(read("10/10"), std::pair(std::size_t{10}, std::size_t{10}));
}

TEST(Shard, OfAnythingElseIsRefused) {
  for (const char* text : {"", "1", "/", "1/", "/3", "0/3", "4/3", "0/0", "-1/3", "1/-3", "1:3",
                           "1/3x", "1/3/5", "1.5/3", "a/b"})
    EXPECT_THROW(parse_shard(text), InputError) << text;
}

}  // namespace
}  // namespace mh
