// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "slam/io/yaml.hpp"

namespace mh {

/// The names of the environments that one entry of a suite's `environments` creates: one for each i
/// from first to end - 1. If there are several, `name` contains {i}.
struct EntryNames {
  std::string category, name;
  int first = 0, end = 1;
};

/// @throws InputError at the place of a key that is missing or invalid.
EntryNames read_names(YamlReader& node);

/// Replaces each {i} with a number.
std::string with_index(std::string text, int index);

}  // namespace mh
