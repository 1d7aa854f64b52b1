// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "slam/io/names.hpp"
#include "slam/io/printable.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

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

/// @throws InputError at this place unless the name is valid as a folder name.
inline void check_folder_name(const YamlReader& node, const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos || name[0] == '.' || !is_legible(name))
    node.fail(fmt::format("'{}' cannot name a folder", printable(name)));
}

}  // namespace mh
