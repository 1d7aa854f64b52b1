// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"

namespace mh {

Stamp parse_stamp(std::string_view text, int unit) {
  const auto fail = [&] {
    throw InputError(fmt::format("'{}' is not a time in {}seconds from 0 to 9.2e{}", text,
                                 unit == 0    ? ""
                                 : unit == -3 ? "milli"
                                 : unit == -6 ? "micro"
                                              : "nano",
                                 9 - unit));
  };
  // value = digits * 10^exponent seconds.
  std::string digits;
  int exponent = unit;
  std::size_t at = !text.empty() && text[0] == '+' ? 1 : 0;
  bool point = false;
  bool any = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '.' && !point) {
      point = true;
    } else if (c >= '0' && c <= '9') {
      any = true;
      if (point) --exponent;
      if (!digits.empty() || c != '0') digits += c;
    } else {
      break;
    }
  }
  if (!any) fail();
  if (at < text.size()) {
    if (text[at] != 'e' && text[at] != 'E') fail();
    int power = 0;
    const char* begin = text.data() + at + 1;
    if (begin != text.data() + text.size() && *begin == '+') ++begin;
    const auto [stop, error] = std::from_chars(begin, text.data() + text.size(), power);
    if (error != std::errc() || stop != text.data() + text.size() || std::abs(power) > 1000) fail();
    exponent += power;
  }
  if (digits.empty()) return 0;
  const int shift = exponent + 9;  // digits * 10^shift nanoseconds
  bool round_up = false;
  if (shift >= 0) {
    if (static_cast<int>(digits.size()) + shift > 19) fail();
    digits.append(static_cast<std::size_t>(shift), '0');
  } else {
    const int kept = static_cast<int>(digits.size()) + shift;
    if (kept < 0) return 0;
    round_up = digits[static_cast<std::size_t>(kept)] >= '5';
    if (kept == 0) return round_up;
    digits.resize(static_cast<std::size_t>(kept));
  }
  Stamp stamp = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), stamp);
  if (error != std::errc() || stamp > 9'200'000'000'000'000'000) fail();
  return stamp + round_up;
}

std::string format_stamp(Stamp stamp_ns) {
  return fmt::format("{}{}.{:09}", stamp_ns < 0 ? "-" : "", std::abs(stamp_ns / 1'000'000'000),
                     std::abs(stamp_ns % 1'000'000'000));
}

}  // namespace mh
