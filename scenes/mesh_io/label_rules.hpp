// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/labels.hpp"
#include "slam/core/yaml.hpp"

namespace mh {

/// A side table that tells the class of things by their names: patterns as in a shell (* ? [a-z]),
/// whatever the case of letters; the first that matches counts.
struct LabelRules {
  struct Rule {
    std::string pattern;
    ClassId class_id = kVoid;
  };
  std::vector<Rule> rules;

  /// The class of a thing that has these names; nullopt if no pattern matches any.
  std::optional<ClassId> find(std::initializer_list<std::string_view> names) const;
};

/// Reads a mapping of pattern to class name. @throws InputError naming line and value.
LabelRules read_label_rules(YamlReader yaml);

/// The table beside a mesh: <stem>.labels.yaml, else labels.yaml; no rules if there is neither.
LabelRules find_label_rules(const std::filesystem::path& mesh);

}  // namespace mh
