// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "slam/core/suggest.hpp"
#include "slam/core/yaml.hpp"

namespace mh {

/// The words of an enumeration, in files both ways.
template <class T, std::size_t N>
using Names = std::array<std::pair<std::string_view, T>, N>;

template <class T, std::size_t N>
std::string_view name_of(T value, const Names<T, N>& names) {
  for (const auto& [name, v] : names)
    if (v == value) return name;
  return "?";
}

template <class T, std::size_t N>
std::optional<T> value_of(std::string_view word, const Names<T, N>& names) {
  for (const auto& [name, value] : names)
    if (name == word) return value;
  return std::nullopt;
}

/// @throws InputError listing the words that are known.
template <class T, std::size_t N>
T one_of(const YamlReader& node, const Names<T, N>& names) {
  const std::string word = node.as_string();
  if (const auto value = value_of(word, names)) return *value;
  const auto known = words_of(names, [](const auto& n) { return n.first; });
  node.fail(
      fmt::format("'{}' is none of {}{}", word, fmt::join(known, ", "), did_you_mean(word, known)));
}

}  // namespace mh
