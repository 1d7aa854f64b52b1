// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "slam/io/names.hpp"
#include "slam/io/printable.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// The elements of a list. @throws InputError if it is empty.
inline std::vector<YamlReader> items_of(const YamlReader& node) {
  std::vector<YamlReader> items = node.items();
  if (items.empty()) node.fail("is empty: at least one is needed");
  return items;
}

/// @param values  the values of the list's items. @throws InputError at the first item that repeats
/// an earlier one.
template <class T>
void require_distinct(const YamlReader& list, const std::vector<T>& values) {
  const std::vector<YamlReader> items = list.items();
  for (std::size_t i = 1; i < items.size(); ++i)
    if (std::find(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i), values[i]) !=
        values.begin() + static_cast<std::ptrdiff_t>(i))
      items[i].fail(fmt::format("'{}' is listed twice", values[i]));
}

/// @throws InputError at this place unless the name is valid as a folder name.
inline void check_folder_name(const YamlReader& node, const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos || name[0] == '.' || !is_legible(name))
    node.fail(fmt::format("'{}' cannot name a folder", printable(name)));
}

}  // namespace mh
