// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/suite.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "slam/core/yaml.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

template <class T, std::size_t N>
using Names = std::array<std::pair<std::string_view, T>, N>;

constexpr Names<SystemKind, 2> kSystems{
    {{"semantic", SystemKind::kSemantic}, {"plain", SystemKind::kPlain}}};
constexpr Names<LabelMode, 4> kLabels{{{"exact", LabelMode::kExact},
                                       {"boxes", LabelMode::kBoxes},
                                       {"detector", LabelMode::kDetector},
                                       {"none", LabelMode::kNone}}};
constexpr Names<Overlap, 3> kOverlaps{
    {{"labels", Overlap::kLabels}, {"augmented", Overlap::kAugmented}, {"words", Overlap::kWords}}};
constexpr Names<DropReset, 2> kResets{{{"counter", DropReset::kCounter}, {"map", DropReset::kMap}}};

template <class T, std::size_t N>
T one_of(const YamlReader& node, const Names<T, N>& names) {
  const std::string word = node.as_string();
  std::string known;
  for (const auto& [name, value] : names) {
    if (name == word) return value;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  node.fail(fmt::format("'{}' is none of {}", word, known));
}

template <class T, std::size_t N>
std::string_view name_of(T value, const Names<T, N>& names) {
  for (const auto& [name, v] : names)
    if (v == value) return name;
  return "?";
}

fs::path existing_file(const YamlReader& node, const fs::path& folder) {
  const fs::path file = (folder / node.as_string()).lexically_normal();
  if (!fs::is_regular_file(file))
    node.fail(fmt::format("'{}' cannot be read: no such file", file.string()));
  return file;
}

/// A list without repetition and with at least one element.
std::vector<YamlReader> items_of(YamlReader node) {
  std::vector<YamlReader> items = node.items();
  if (items.empty()) node.fail("is empty: at least one is needed");
  return items;
}

template <class T>
void add_once(std::vector<T>& list, T value, const YamlReader& node) {
  if (std::find(list.begin(), list.end(), value) != list.end())
    node.fail(fmt::format("'{}' stands twice", node.as_string()));
  list.push_back(std::move(value));
}

double half_open_share(YamlReader& node, const std::string& key, double fallback) {
  const auto child = node.find(key);
  if (!child) return fallback;
  const double value = child->as_double();
  if (value < 0.0 || value >= 1.0) child->fail(fmt::format("{} is outside [0, 1)", value));
  return value;
}

SemanticConfig read_semantics(YamlReader node) {
  SemanticConfig c;
  c.gamma = node.number_or("gamma", c.gamma, 0.0, 1e6);
  c.xi = node.number_or("xi", c.xi, 1.0, 1e6);
  c.alpha = half_open_share(node, "alpha", c.alpha);
  c.beta = half_open_share(node, "beta", c.beta);
  if (const auto overlap = node.find("overlap")) c.overlap = one_of(*overlap, kOverlaps);
  c.void_is_a_label = node.boolean("void_is_a_label", c.void_is_a_label);
  node.finish();
  return c;
}

ProtocolConfig read_protocol(YamlReader node) {
  ProtocolConfig c;
  const auto count = [&](const char* key, int fallback, int min, int max) {
    return static_cast<int>(node.integer_or(key, fallback, min, max));
  };
  c.test_interval = count("test_interval", c.test_interval, 2, 100000);
  c.rewind_frames = count("rewind_frames", c.rewind_frames, 1, 100000);
  c.restarts_per_frame = count("restarts_per_frame", c.restarts_per_frame, 0, 1000);
  if (const auto reset = node.find("reset")) c.reset = one_of(*reset, kResets);
  c.max_effort = node.number_or("max_effort", c.max_effort, 1.0, 1000.0);
  c.query_attempts = count("query_attempts", c.query_attempts, 1, 1000);
  c.max_blank_frames = count("max_blank_frames", c.max_blank_frames, 1, 100000);
  c.correct_distance_m = node.number_or("correct_distance_m", c.correct_distance_m, 0.0, 1000.0);
  c.correct_angle_deg = node.number_or("correct_angle_deg", c.correct_angle_deg, 0.0, 180.0);
  node.finish();
  return c;
}

}  // namespace

std::string_view name(SystemKind system) {
  return name_of(system, kSystems);
}
std::string_view name(LabelMode labels) {
  return name_of(labels, kLabels);
}
std::string_view name(Overlap overlap) {
  return name_of(overlap, kOverlaps);
}
std::string level_name(const fs::path& level) {
  return level.stem().string();
}

Suite load_suite(const fs::path& file, const SuiteOverrides& overrides) {
  YamlReader yaml = YamlReader::load(file);
  const fs::path folder = file.parent_path();

  Suite suite;
  suite.file = file;
  suite.name = yaml.string("name", file.stem().string());
  if (suite.name.empty() || suite.name.find('/') != std::string::npos || suite.name[0] == '.')
    yaml.at("name").fail(fmt::format("'{}' cannot name a folder", suite.name));
  if (overrides.scene) {
    if (!fs::is_regular_file(*overrides.scene))
      throw InputError(fmt::format("{}: cannot be read: no such file", overrides.scene->string()));
    yaml.find("scene");  // counts as read
    suite.scene = *overrides.scene;
  } else {
    suite.scene = existing_file(yaml.at("scene"), folder);
  }
  suite.robot = existing_file(yaml.at("robot"), folder);
  suite.mapping_tour = existing_file(yaml.at("mapping_tour"), folder);
  if (const auto tour = yaml.find("query_tour")) suite.query_tour = existing_file(*tour, folder);
  suite.vocabulary = existing_file(yaml.at("vocabulary"), folder);
  for (const YamlReader& level : items_of(yaml.at("levels")))
    add_once(suite.levels, existing_file(level, folder), level);
  for (const YamlReader& system : items_of(yaml.at("systems")))
    add_once(suite.systems, one_of(system, kSystems), system);
  for (const YamlReader& labels : items_of(yaml.at("labels")))
    add_once(suite.labels, one_of(labels, kLabels), labels);
  suite.trials = static_cast<int>(yaml.integer_or("trials", suite.trials, 1, 1000));
  if (overrides.trials) suite.trials = *overrides.trials;
  suite.seed = static_cast<std::uint64_t>(yaml.integer_or("seed", 0, 0, INT64_MAX / 2));
  if (const auto slam = yaml.find("slam")) suite.semantics = read_semantics(*slam);
  if (const auto protocol = yaml.find("protocol")) suite.protocol = read_protocol(*protocol);
  yaml.finish();
  return suite;
}

}  // namespace mh
