// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/labels.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// A side table that maps names to classes. Names are given as shell patterns (* ? [a-z]) and
/// matched ignoring letter case; the first match wins.
struct LabelRules {
  struct Rule {
    std::string pattern;
    ClassId class_id = kVoid;
  };
  std::vector<Rule> rules;

  /// The class of a thing with these names; nullopt if no pattern matches.
  std::optional<ClassId> find(std::initializer_list<std::string_view> names) const;
};

/// Reads a mapping from patterns to class names. @throws InputError naming line and value.
LabelRules read_label_rules(YamlReader yaml);

/// The table next to a mesh: <stem>.labels.yaml, otherwise labels.yaml; no rules if neither exists.
LabelRules find_label_rules(const std::filesystem::path& mesh);

}  // namespace mh
