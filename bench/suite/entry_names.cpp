// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/entry_names.hpp"

#include <fmt/format.h>

#include "bench/suite/names.hpp"

namespace mh {

EntryNames read_names(YamlReader& node) {
  EntryNames names;
  const int count = static_cast<int>(node.integer_or("count", 1, 1, 100000));
  names.first = static_cast<int>(node.integer_or("first", 0, 0, 100000));
  names.end = names.first + count;
  names.category = node.string("category");
  check_folder_name(node.at("category"), names.category);
  names.name = node.string("name", node.has("count") ? names.category + "-{i}" : names.category);
  if (count > 1 && names.name.find("{i}") == std::string::npos)
    node.at("name").fail(
        fmt::format("'{}' needs an {{i}}: there are {} of them", names.name, count));
  return names;
}

std::string with_index(std::string text, int index) {
  const std::string mark = "{i}", number = std::to_string(index);
  for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark, at + number.size()))
    text.replace(at, mark.size(), number);
  return text;
}

}  // namespace mh
