// SPDX-License-Identifier: Apache-2.0
#include "slam/io/narrowed.hpp"

#include <cstdint>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/io/error.hpp"
#include "slam/io/json_number.hpp"

namespace mh {
namespace {

template <class To, class From>
void expect_limits_of() {
  // The upper limit is tested only if From can tell it from the next number.
  EXPECT_EQ(narrowed<To>(From{0}), To{0});
  EXPECT_EQ(narrowed<To>(From{100}), To{100});
  if constexpr (std::numeric_limits<From>::digits > std::numeric_limits<To>::digits) {
    const auto greatest = static_cast<From>(std::numeric_limits<To>::max());
    EXPECT_EQ(narrowed<To>(greatest), std::numeric_limits<To>::max());
    EXPECT_EQ(narrowed<To>(static_cast<From>(greatest + 1)), std::nullopt);
  }
  if constexpr (std::is_signed_v<From> && std::is_unsigned_v<To>) {
    EXPECT_EQ(narrowed<To>(From{-1}), std::nullopt);
  }
}

TEST(Narrowed, KeepsWhatFitsAndNothingElse) {
  expect_limits_of<std::uint8_t, int>();
  expect_limits_of<std::uint16_t, double>();
  expect_limits_of<std::uint16_t, std::int64_t>();
  expect_limits_of<std::int16_t, float>();
  expect_limits_of<std::int32_t, std::uint64_t>();
  expect_limits_of<std::uint32_t, double>();
  expect_limits_of<std::int64_t, double>();
  expect_limits_of<std::uint64_t, std::int8_t>();
  EXPECT_EQ(narrowed<std::int8_t>(-128), -128);
  EXPECT_EQ(narrowed<std::int8_t>(-129), std::nullopt);
  EXPECT_EQ(narrowed<std::int8_t>(-128.0), -128);
  EXPECT_EQ(narrowed<std::int8_t>(-129.0), std::nullopt);
}

TEST(Narrowed, BrokenAndEndlessNumbersAreNone) {
  for (const double value : {5.9, -0.5, 1e30, -1e30, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(narrowed<std::uint16_t>(value), std::nullopt) << value;
  // 2^64 and 2^63 are doubles; the numbers before them are not.
  EXPECT_EQ(narrowed<std::uint64_t>(18446744073709551616.0), std::nullopt);
  EXPECT_EQ(narrowed<std::int64_t>(9223372036854775808.0), std::nullopt);
  EXPECT_EQ(narrowed<std::int64_t>(-9223372036854775808.0),
            std::numeric_limits<std::int64_t>::min());
}

TEST(Narrowed, JsonNumbersAreCheckedAsTheyStand) {
  using Json = nlohmann::json;
  const auto number = [](const char* text) {
    return whole_number<std::uint16_t>(Json::parse(text));
  };
  EXPECT_EQ(number("5"), 5);
  EXPECT_EQ(number("5.0"), 5);
  EXPECT_EQ(number("65535"), 65535);
  for (const char* bad : {"65536", "65541", "-1", "5.9", "1e30", "18446744073709551616", "null",
                          "true", "\"5\"", "[5]"})
    EXPECT_THROW(number(bad), InputError) << bad;
}

}  // namespace
}  // namespace mh
