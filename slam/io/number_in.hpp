// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace mh {

/// The value of a word that is entirely a decimal number without a leading plus; otherwise, or
/// beyond a double's range, nullopt. "nan" and "inf" are numbers here.
inline std::optional<double> number_in(std::string_view word) {
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// The word without one leading plus.
inline std::string_view without_plus(std::string_view word) {
  return word.starts_with('+') ? word.substr(1) : word;
}

}  // namespace mh
