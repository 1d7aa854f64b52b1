// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

namespace mh {

/// Converts a number read from a file to To; nullopt if it is not exactly representable: too large,
/// negative, fractional or not finite.
template <std::integral To, class From>
requires std::is_arithmetic_v<From> std::optional<To> narrowed(From value) {
  if constexpr (std::is_floating_point_v<From>) {
    // One past the largest To is a power of two, which any floating-point type represents exactly.
    const From end = std::ldexp(From{1}, std::numeric_limits<To>::digits);
    const From begin = std::is_signed_v<To> ? -end : From{0};
    if (!(value >= begin && value < end) || value != std::trunc(value)) return std::nullopt;
  } else if (!std::in_range<To>(value)) {
    return std::nullopt;
  }
  return static_cast<To>(value);
}

}  // namespace mh
