// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace mh {

/// A word that is a decimal number as a whole, without a leading plus; nullopt for any other, or
/// one beyond a double's range. "nan" and "inf" are numbers here.
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
