// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/narrowed.hpp"

namespace mh {

/// Returns a JSON value as an integer of exactly that value; nlohmann's get<>() would truncate.
/// @throws InputError naming the value found and the allowed range.
template <std::integral To, class Json>
To whole_number(const Json& value) {
  std::optional<To> number;
  if (value.is_number_unsigned())
    number = narrowed<To>(value.template get<std::uint64_t>());
  else if (value.is_number_integer())
    number = narrowed<To>(value.template get<std::int64_t>());
  else if (value.is_number_float())
    number = narrowed<To>(value.template get<double>());
  if (!number)
    throw InputError(fmt::format("{} is not an integer from {} to {}",
                                 value.is_number() ? value.dump() : value.type_name(),
                                 std::numeric_limits<To>::min(), std::numeric_limits<To>::max()));
  return *number;
}

}  // namespace mh
