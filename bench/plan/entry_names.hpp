// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "slam/core/yaml.hpp"

namespace mh {

/// How an entry of a suite's `environments` names them, and which it creates: {i} from first to
/// end - 1; if several, `name` contains {i}.
struct EntryNames {
  std::string category, name;
  int first = 0, end = 1;
};

/// @throws InputError at the place of a key that is missing or invalid.
EntryNames read_names(YamlReader& node);

/// Replaces each {i} by a number.
std::string with_index(std::string text, int index);

}  // namespace mh
