// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "slam/io/suggest.hpp"
#include "slam/io/words.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// Looks up the value of a word in a file. @throws InputError listing the known words.
template <class T, std::size_t N>
T one_of(const YamlReader& node, const Names<T, N>& names) {
  const std::string word = node.as_string();
  if (const auto value = value_of(word, names)) return *value;
  const auto known = words_of(names, [](const auto& n) { return n.first; });
  node.fail(fmt::format("'{}' is not one of {}{}", word, fmt::join(known, ", "),
                        did_you_mean(word, known)));
}

}  // namespace mh
