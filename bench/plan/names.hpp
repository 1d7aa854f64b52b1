// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

/// The elements of a list. @throws InputError if there is none.
inline std::vector<YamlReader> items_of(const YamlReader& node) {
  std::vector<YamlReader> items = node.items();
  if (items.empty()) node.fail("is empty: at least one is needed");
  return items;
}

template <class T>
void add_once(std::vector<T>& list, T value, const YamlReader& node) {
  if (std::find(list.begin(), list.end(), value) != list.end())
    node.fail(fmt::format("'{}' stands twice", node.as_string()));
  list.push_back(std::move(value));
}

/// @throws InputError at this place unless a folder can have the name.
inline void check_folder_name(const YamlReader& node, const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos || name[0] == '.')
    node.fail(fmt::format("'{}' cannot name a folder", name));
}

}  // namespace mh
