// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace mh {

/// The words of an enumeration E, for reading and writing files. Next to E is a function
/// `constexpr Names<E, N> words(E)` that returns them: whatever reads or writes an E uses it.
template <class T, std::size_t N>
using Names = std::array<std::pair<std::string_view, T>, N>;

template <class T, std::size_t N>
constexpr std::string_view name_of(T value, const Names<T, N>& names) {
  for (const auto& [name, v] : names)
    if (v == value) return name;
  return "?";
}

template <class T, std::size_t N>
constexpr std::optional<T> value_of(std::string_view word, const Names<T, N>& names) {
  for (const auto& [name, value] : names)
    if (name == word) return value;
  return std::nullopt;
}

}  // namespace mh
