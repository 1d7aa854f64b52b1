// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/episodes_spec.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/suite/names.hpp"
#include "slam/core/labels.hpp"
#include "slam/io/settings_io.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

void check_goal(const YamlReader& node) {
  const std::string goal = node.as_string();
  if (!class_by_name(goal))
    node.fail(fmt::format("'{}' is not a class of objects{}", goal,
                          hint(goal, words_of(classes(), [](const ClassInfo& c) { return c.name; }),
                               "modelhouse reference classes")));
}

EpisodeVariant read_variant(YamlReader node, const SuitePaths& paths) {
  EpisodeVariant variant;
  variant.name = node.string("name");
  check_folder_name(node.at("name"), variant.name);
  sources(variant, [&](const WorldSource& source, auto& file) {
    if (const auto named = node.find(source.key)) file = read_source(source.kind, *named, paths);
  });
  node.finish();
  return variant;
}

}  // namespace

EpisodesSpec read_episodes(YamlReader node, const SuitePaths& paths) {
  EpisodesSpec spec;
  MappingReader reader(node);
  episode_settings(spec, reader);
  for (const YamlReader& goal : node.at("goals").items()) check_goal(goal);
  require_distinct(node.at("goals"), spec.goals);
  if (spec.dark_s >= spec.limit_s)
    node.fail(fmt::format("dark_s, {:g} s, leaves nothing of limit_s, {:g} s", spec.dark_s,
                          spec.limit_s));
  if (const auto list = node.find("variants")) {
    spec.variants.clear();
    for (const YamlReader& item : items_of(*list))
      spec.variants.push_back(read_variant(item, paths));
    std::vector<std::string> names;
    for (const EpisodeVariant& variant : spec.variants) names.push_back(variant.name);
    require_distinct(*list, names);
  }
  node.finish();
  return spec;
}

}  // namespace mh
