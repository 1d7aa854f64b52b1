// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/episodes_spec.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "bench/suite/names.hpp"
#include "slam/core/labels.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

/// @throws InputError at this place, with suggestions, if nothing is called that.
std::string read_goal(const YamlReader& node) {
  const std::string goal = node.as_string();
  if (!class_by_name(goal))
    node.fail(fmt::format("'{}' is no class of things{}", goal,
                          hint(goal, words_of(classes(), [](const ClassInfo& c) { return c.name; }),
                               "modelhouse reference classes")));
  return goal;
}

EpisodeVariant read_variant(YamlReader& node, const SuitePaths& paths) {
  EpisodeVariant variant;
  variant.name = node.string("name");
  if (variant.name.empty() || variant.name.find_first_of("/\\ .") != std::string::npos)
    node.at("name").fail(fmt::format("'{}' cannot name a folder", variant.name));
  const auto file = [&](const char* key, Shipped what) -> std::optional<std::filesystem::path> {
    if (const auto named = node.find(key)) return named_file(*named, paths, what);
    return std::nullopt;
  };
  variant.scene = file("scene", Shipped::kScene);
  variant.level = file("level", Shipped::kLevel);
  if (const auto named = node.find("pedestrian")) variant.pedestrian = named_file(*named, paths);
  node.finish();
  return variant;
}

}  // namespace

EpisodesSpec read_episodes(YamlReader node, const SuitePaths& paths) {
  EpisodesSpec spec;
  YamlReader goals = node.at("goals");
  for (const YamlReader& goal : goals.items()) add_once(spec.goals, read_goal(goal), goal);
  if (spec.goals.empty()) goals.fail("is empty: at least one is needed");
  spec.starts = static_cast<std::size_t>(
      node.integer_or("starts", static_cast<std::int64_t>(spec.starts), 1, 100000));
  spec.seed = static_cast<std::uint64_t>(node.integer_or("seed", 0, 0, INT64_MAX));
  spec.limit_s = node.number_or("limit_s", spec.limit_s, 1, 3600);
  spec.arrival_m = node.number_or("arrival_m", spec.arrival_m, 0.5, 10);
  spec.ticks_per_frame =
      static_cast<int>(node.integer_or("ticks_per_frame", spec.ticks_per_frame, 1, 60));
  spec.dark_s = node.number_or("dark_s", spec.dark_s, 0, 60);
  if (spec.dark_s >= spec.limit_s)
    node.fail(fmt::format("dark_s, {:g} s, leaves nothing of limit_s, {:g} s", spec.dark_s,
                          spec.limit_s));
  if (const auto list = node.find("variants")) {
    spec.variants.clear();
    std::set<std::string> names;
    for (YamlReader& item : list->items()) {
      spec.variants.push_back(read_variant(item, paths));
      if (!names.insert(spec.variants.back().name).second)
        item.fail(fmt::format("'{}' stands twice", spec.variants.back().name));
    }
    if (spec.variants.empty()) list->fail("is empty: at least one is needed");
  }
  node.finish();
  return spec;
}

}  // namespace mh
