// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "slam/io/error.hpp"

namespace mh {

/// The bytes that libFuzzer generated.
inline std::string_view bytes_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Bad input must end in InputError and nothing else.
template <class Function>
void try_input(Function&& function) {
  try {
    function();
  } catch (const InputError&) {
  }
}

}  // namespace mh
