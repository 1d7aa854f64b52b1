// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/label_rules.hpp"

#include <fnmatch.h>

#include <fmt/format.h>

#include "slam/io/files.hpp"
#include "slam/io/suggest.hpp"

namespace mh {

std::optional<ClassId> LabelRules::find(std::initializer_list<std::string_view> names) const {
  for (const Rule& rule : rules)
    for (const std::string_view name : names)
      if (fnmatch(rule.pattern.c_str(), std::string(name).c_str(), FNM_CASEFOLD) == 0)
        return rule.class_id;
  return std::nullopt;
}

LabelRules read_label_rules(YamlReader yaml) {
  LabelRules rules;
  for (const auto& [pattern, value] : yaml.entries()) {
    const std::string name = value.as_string();
    const auto class_id = class_by_name(name);
    if (!class_id)
      value.fail(fmt::format("'{}' is not a class{}", name,
                             hint(name, words_of(classes(), &ClassInfo::name),
                                  "modelhouse reference classes lists all")));
    rules.rules.push_back({pattern, *class_id});
  }
  return rules;
}

LabelRules find_label_rules(const std::filesystem::path& mesh) {
  for (const auto& file : {std::filesystem::path(mesh).replace_extension(".labels.yaml"),
                           mesh.parent_path() / "labels.yaml"})
    if (is_file(file)) return read_label_rules(YamlReader::load(file));
  return {};
}

}  // namespace mh
