// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/suite.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>

#include "bench/suite/gate_config.hpp"
#include "bench/suite/names.hpp"
#include "bench/suite/run_spec.hpp"
#include "scenes/scannet/files.hpp"
#include "sim/simulation/faulty_sequence.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/config/by_name.hpp"
#include "slam/config/slam.hpp"
#include "slam/files/settings_file.hpp"
#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/settings_io.hpp"
#include "slam/io/suggest.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// @throws InputError at this place if no system of the suite has the name.
std::size_t system_named(const YamlReader& node, const std::vector<SystemSpec>& systems) {
  const std::string name = node.as_string();
  const auto found = std::ranges::find(systems, name, &SystemSpec::name);
  if (found == systems.end()) {
    const auto known = words_of(systems, [](const SystemSpec& s) { return s.name; });
    node.fail(fmt::format("'{}' is not one of the suite's systems{}", name, hint(name, known)));
  }
  return static_cast<std::size_t>(found - systems.begin());
}

/// Reads pairs of different systems, no pair twice; default: semantic and plain.
std::vector<SystemPair> read_compare(YamlReader& yaml, const std::vector<SystemSpec>& systems) {
  std::vector<SystemPair> pairs;
  const auto node = yaml.find("compare");
  if (!node) {
    const auto own = [&](SystemKind kind) {
      return static_cast<std::size_t>(std::ranges::find(systems, name(kind), &SystemSpec::name) -
                                      systems.begin());
    };
    const SystemPair pair{own(SystemKind::kSemantic), own(SystemKind::kPlain)};
    if (pair.first < systems.size() && pair.second < systems.size()) pairs.push_back(pair);
    return pairs;
  }
  for (const YamlReader& item : node->items()) {
    const std::vector<YamlReader> names = item.items();
    if (names.size() != 2) item.fail("must be two systems: [first, second]");
    const SystemPair pair{system_named(names[0], systems), system_named(names[1], systems)};
    if (pair.first == pair.second) item.fail("compares a system with itself");
    if (std::ranges::find(pairs, pair) != pairs.end()) item.fail("is listed twice");
    pairs.push_back(pair);
  }
  return pairs;
}

Environment& only_environment(Suite& suite, const char* option) {
  if (suite.environments.size() != 1)
    throw InputError(fmt::format("{}: {} needs a suite of one environment, this has {}",
                                 suite.file.string(), option, suite.environments.size()));
  if (suite.environments.front().is_recorded())
    throw InputError(fmt::format("{}: {} is for scenes, but '{}' is a recording",
                                 suite.file.string(), option, suite.environments.front().name));
  return suite.environments.front();
}

/// @throws InputError at `node` if a level has a fault that cannot be added to finished images
void check_finished(const YamlReader& node, const Level& level) {
  if (!level.of_recordings) return;
  if (const auto faults = faults_of_scene(sensors_at(level)); !faults.empty())
    node.fail(fmt::format("cannot be added to a recording: {}", fmt::join(faults, "; ")));
}

/// Reads the levels. They are of the scenes, if there are any; recordings are then as recorded.
std::vector<Level> read_levels(YamlReader& yaml, const SuitePaths& paths, const Suite& suite) {
  const auto is_recorded = [](const Environment& e) { return e.is_recorded(); };
  const bool only_recordings = std::ranges::all_of(suite.environments, is_recorded);
  std::vector<Level> levels;
  if (!only_recordings || yaml.has("levels")) {
    std::set<std::string> names;
    for (const YamlReader& node : items_of(yaml.at("levels"))) {
      const bool as_recorded = only_recordings && node.as_string() == kRecordedLevel;
      levels.push_back({.file = as_recorded ? fs::path(kRecordedLevel)
                                            : named_file(node, paths, Shipped::kLevel),
                        .of_recordings = only_recordings});
      const std::string name = level_name(levels.back());
      if (!names.insert(name).second) node.fail(fmt::format("'{}' is listed twice", name));
      if (name == kRecordedLevel && !as_recorded)
        node.fail("is reserved for the level of recordings");
      if (paths.must_exist) check_finished(node, levels.back());
    }
  }
  if (std::ranges::any_of(suite.environments, is_recorded) && (levels.empty() || !only_recordings))
    levels.push_back({.file = kRecordedLevel, .of_recordings = true});
  return levels;
}

/// Checks the dials of a stress test at the suite's levels: no fault is no fault, the strongest
/// dose is possible. @throws InputError at the dial
void check_doses(YamlReader& stress, const Suite& suite) {
  for (const StressDial& dial : suite.stress->dials) {
    const YamlReader node = YamlReader(stress.at("dials")).at(dial.dial);
    for (const Level& level : suite.levels) {
      const auto at = [&](double dose) {
        Level dosed = level;
        dosed.doses.push_back({dial.dial, dose});
        try {
          return sensors_at(dosed);
        } catch (const InputError& error) {
          node.fail(error.what());
        }
      };
      if (level.of_recordings)
        if (const auto faults = faults_of_scene(at(dial.to)); !faults.empty())
          node.fail(fmt::format("cannot be added to a recording: {}", fmt::join(faults, "; ")));
      at(dial.to);
      if (!(effective(at(dial.from)) == effective(sensors_at(level))))
        node.fail(fmt::format("from: {} is not what level '{}' has: it would be a fault itself",
                              dial.from, level_name(level)));
    }
  }
}

/// Each level with each combination of doses.
std::vector<Level> dosed(const std::vector<Level>& levels,
                         const std::vector<std::vector<Dose>>& combinations) {
  std::vector<Level> all;
  for (const Level& level : levels)
    for (const std::vector<Dose>& doses : combinations) {
      all.push_back(level);
      all.back().doses = doses;
    }
  return all;
}

/// Boxes from a file belong to the frames of one sequence, so no environment may have a second
/// sequence.
void check_boxes(const YamlReader& node, const Labels& labels, const Suite& suite) {
  if (!labels.detector || labels.detector->boxes.empty()) return;
  for (const Environment& e : suite.environments)
    if (e.query_tour || e.queries)
      node.fail(fmt::format(
          "boxes belong to the frames of one sequence, but '{}' has a second one for queries",
          e.name));
}

/// Reads the kinds of labels: each must fit some environment, and each environment needs at least
/// one.
std::vector<Labels> read_labels(const YamlReader& list, const Suite& suite,
                                const fs::path& folder) {
  std::vector<Labels> all;
  for (const YamlReader& node : items_of(list)) {
    const Labels labels = read_label_source(node, folder);
    const auto same = [&](const Labels& l) { return name(l) == name(labels); };
    if (std::ranges::any_of(all, same))
      node.fail(fmt::format("'{}' is listed twice", name(labels)));
    check_boxes(node, labels, suite);
    all.push_back(labels);
    if (std::ranges::any_of(suite.environments,
                            [&](const Environment& e) { return fits(e, labels); }))
      continue;
    node.fail(labels.mode == LabelMode::kRecorded
                  ? "'recorded' labels are a recording's (`sequence`), and no environment is one"
                  : fmt::format("'{}' labels are rendered from a simulated scene; recordings have "
                                "'recorded' ones, a detector's or 'none'",
                                name(labels)));
  }
  for (const Environment& e : suite.environments)
    if (std::ranges::none_of(all, [&](const Labels& labels) { return fits(e, labels); }))
      list.fail(fmt::format("none of them is for '{}', which is {}", e.name,
                            e.is_recorded() ? "a recording: 'recorded', a detector's or 'none'"
                                            : "a scene: 'exact', 'none' or another"));
  return all;
}

/// A study states its design before its evaluation begins, and its suite gives the digest of that
/// text: a design that has changed since is refused.
void check_design(YamlReader study, const SuitePaths& paths) {
  const fs::path file = named_file(study.at("design"), paths);
  const std::string stated = study.string("xxh3");
  study.finish();
  if (!paths.must_exist) return;
  const std::string text = read_text(file);
  const std::string found = fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
  if (found != stated)
    study.at("xxh3").fail(
        fmt::format("the design {} has changed since it was stated: its xxh3 is {}, not '{}'. "
                    "Restore it, or state a new study",
                    file.string(), found, stated));
}

/// Whether two points of the sweep differ for any system.
bool any_system_varies(const Suite& suite) {
  const std::vector<SharedSlamConfig>& points = suite.sweep.points;
  return points.size() < 2 || std::ranges::any_of(suite.systems, [&](const SystemSpec& system) {
           const SlamConfig first = settings_of(system, points.front());
           return std::ranges::any_of(points, [&](const SlamConfig& point) {
             return !(settings_of(system, point) == first);
           });
         });
}

/// The value of a variable of the suite. @throws InputError if it was not set.
std::string value_of(const std::string& name, const SuiteOverrides& overrides) {
  const auto value = overrides.set.find(name);
  if (value == overrides.set.end())
    throw InputError(fmt::format(
        "'${{{0}}}' is not set: use --set {0}=VALUE{1}", name,
        overrides.set.empty() ? "" : fmt::format(" (set is '{}')", overrides.set.begin()->first)));
  return value->second;
}

/// The section `parameters` that is equivalent to --vary: on one map if that is possible.
YamlReader sweep_of(const std::map<std::string, std::string>& vary) {
  const bool fixed =
      std::ranges::all_of(vary, [](const auto& of) { return of.first.starts_with("semantics."); });
  std::string text = fmt::format("map: {}\n", fixed ? "fixed" : "rebuilt");
  for (const auto& [name, values] : vary) text += fmt::format("{}: [{}]\n", name, values);
  return YamlReader::parse(text, "--vary");
}

std::vector<Sense> read_senses(YamlReader& yaml, const std::vector<Environment>& environments) {
  std::vector<Sense> senses;
  const auto list = yaml.find("senses");
  if (!list) return senses;
  for (const YamlReader& node : items_of(*list)) {
    const Sense sense = one_of(node, words(Sense{}));
    if (std::ranges::count(senses, sense) > 0)
      node.fail(fmt::format("'{}' is listed twice", node.as_string()));
    senses.push_back(sense);
    for (const Environment& e : environments) {
      if (sense == Sense::kImu) continue;
      if (e.is_recorded() || !is_driven(e.mapping_tour))
        node.fail(fmt::format("is for a robot that drives, but '{}' is {}", e.name,
                              e.is_recorded() ? "a recording" : "a handheld scan"));
    }
  }
  return senses;
}

/// Reads "ORB-SLAM2: {rgbd_dataset_freiburg1_desk: 0.016}" and so on. The names may be of
/// environments that are not available.
std::map<std::string, std::map<std::string, double>> read_published_ate(YamlReader& yaml) {
  std::map<std::string, std::map<std::string, double>> published;
  if (auto systems = yaml.find("published_ate_m"))
    for (auto& [system, of_it] : systems->entries())
      for (const auto& [environment, ate_m] : of_it.entries())
        published[system][environment] = ate_m.as_double(0);
  return published;
}

}  // namespace

bool fits(const Environment& environment, const Labels& labels) {
  return labels.mode == LabelMode::kNone ||
         environment.is_recorded() == (labels.mode == LabelMode::kRecorded);
}
bool fits(const Environment& environment, const Level& level) {
  return environment.is_recorded() == level.of_recordings;
}

Suite load_suite(const fs::path& file, const SuiteOverrides& overrides) {
  return parse_suite(read_text(file), file, overrides);
}

Suite parse_suite(const std::string& content, const fs::path& file, const SuiteOverrides& overrides,
                  bool files_must_exist) {
  std::set<std::string> asked;
  YamlReader yaml = YamlReader::parse(content, file.string(), [&](const std::string& name) {
    asked.insert(name);
    return value_of(name, overrides);
  });
  for (const auto& [name, value] : overrides.set)
    if (!asked.contains(name))
      throw InputError(
          fmt::format("{}: --set {}: nothing in it is called ${{{}}}{}", file.string(), name, name,
                      is_setting(name) ? "; SLAM settings go into the suite, under `slam:`"
                                       : did_you_mean(name, {asked.begin(), asked.end()})));
  const SuitePaths paths{file.parent_path(), files_must_exist, overrides.found};

  Suite suite;
  suite.file = file;
  suite.text = content;
  suite.name = yaml.string("name", file.stem().string());
  if (yaml.has("name")) check_folder_name(yaml.at("name"), suite.name);
  std::optional<fs::path> robot;
  if (const auto node = yaml.find("robot")) robot = named_file(*node, paths, Shipped::kRobot);
  Environments environments = read_environments(yaml.at("environments"), paths, robot);
  suite.environments = std::move(environments.list);
  suite.found = std::move(environments.found);
  suite.notes = std::move(environments.notes);
  suite.set = overrides.set;
  suite.levels = read_levels(yaml, paths, suite);
  std::set<std::string> names;
  for (const YamlReader& system : items_of(yaml.at("systems"))) {
    for (SystemSpec& spec : read_systems(system, paths)) {
      if (!names.insert(spec.name).second)
        system.fail(fmt::format("'{}' is listed twice", spec.name));
      suite.systems.push_back(std::move(spec));
    }
  }
  suite.compare = read_compare(yaml, suite.systems);
  if (yaml.has("vocabulary") || std::ranges::any_of(suite.systems, &SystemSpec::takes_settings))
    suite.vocabulary = named_file(yaml.at("vocabulary"), paths, Shipped::kVocabulary);
  suite.labels = read_labels(yaml.at("labels"), suite, paths.folder);
  MappingReader reader(yaml);
  fields(suite, reader);
  suite.published_ate_m = read_published_ate(yaml);
  if (const auto study = yaml.find("study")) check_design(*study, paths);
  bool states_readout = false;
  if (auto slam = yaml.find("slam")) {
    states_readout = slam->has("track") && slam->at("track").has("readout_s");
    suite.slam = read_slam_config(*slam);
    slam->finish();
  }
  const auto sweep =
      overrides.vary.empty() ? yaml.find("parameters") : std::optional(sweep_of(overrides.vary));
  if (!overrides.vary.empty() && yaml.has("parameters"))
    yaml.at("parameters").fail("the suite has a sweep of its own: leave --vary out");
  if (sweep) {
    suite.sweep = read_sweep(*sweep, suite.slam);
    if (!suite.sweep.doses.empty()) suite.levels = dosed(suite.levels, suite.sweep.doses);
    if (files_must_exist)
      for (const Level& level : suite.levels) check_finished(*sweep, level);
    if (yaml.has("study"))
      sweep->fail(
          "a sweep in a stated study would choose among its points by the rooms that evaluate "
          "them. "
          "Sweep over tuning rooms, in a suite without 'study', and state the point chosen");
    if (!any_system_varies(suite))
      sweep->fail(
          "no system of the suite uses what is varied: the plain one ignores settings of labels, "
          "an outside one all SLAM settings");
  }
  if (yaml.has("episodes")) suite.protocol = live_feed();  // a driving robot cannot rewind
  SettingsReader protocol(yaml);
  protocol.section("protocol");
  fields(suite.protocol, protocol);
  protocol.finish();
  if (suite.protocol.test_interval == 1)
    yaml.at("protocol").at("test_interval").fail("would hold out every frame");
  if (suite.protocol.test_interval == 0)
    for (const Environment& e : suite.environments)
      if (e.query_tour || e.queries) {
        suite.notes.push_back(
            fmt::format("{}: protocol.test_interval is 0: no frame is queried, not even from the "
                        "second tour of '{}'",
                        file.string(), e.name));
        break;
      }
  suite.senses = read_senses(yaml, suite.environments);
  if (const auto graded = yaml.find("graded")) {
    suite.graded = read_graded(*graded);
    for (const Environment& e : suite.environments)
      if (e.is_recorded())
        graded->fail(
            fmt::format("queries are drawn from a scene, but '{}' is a recording", e.name));
  }
  if (const auto episodes = yaml.find("episodes")) {
    suite.episodes = read_episodes(*episodes, paths);
    for (const Environment& e : suite.environments)
      if (e.is_recorded())
        episodes->fail(fmt::format("a robot drives in a scene, but '{}' is a recording", e.name));
  }
  if (auto stress = yaml.find("stress")) {
    suite.stress = read_stress(*stress);
    if (files_must_exist) check_doses(*stress, suite);
  }
  if (const auto check = yaml.find("check")) {
    std::vector<std::string> names_of_all;
    for (const Environment& e : suite.environments) names_of_all.push_back(e.name);
    suite.gate = read_gate(*check, names_of_all);
  }
  yaml.finish();
  states_readout = states_readout || std::ranges::count(suite.sweep.varied, "track.readout_s") > 0;
  for (const SystemSpec& system : suite.systems)
    for (const auto& [setting, value] : system.settings)
      states_readout = states_readout || setting == "track.readout_s";
  for (Environment& e : suite.environments)
    e.suite_states_readout = states_readout && e.is_recorded();

  if (overrides.scene) {
    if (files_must_exist && !is_scannet_scene(*overrides.scene)) require_readable(*overrides.scene);
    Environment& environment = only_environment(suite, "--scene");
    environment.scene = *overrides.scene;
    environment.frame = {};
    suite.scene_replaced = true;
  }
  if (overrides.frame.up) only_environment(suite, "--up").frame.up = overrides.frame.up;
  if (overrides.frame.floor_z_m)
    only_environment(suite, "--floor-z").frame.floor_z_m = overrides.frame.floor_z_m;
  if (overrides.trials) suite.trials = *overrides.trials;
  suite.max_frames = overrides.max_frames;
  return suite;
}

}  // namespace mh
