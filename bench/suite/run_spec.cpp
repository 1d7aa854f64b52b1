// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/run_spec.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bench/suite/json_fields.hpp"
#include "slam/config/by_name.hpp"
#include "slam/config/slam.hpp"
#include "slam/io/error.hpp"
#include "slam/io/json_text.hpp"

namespace mh {

nlohmann::ordered_json to_json(const RunSpec& spec) {
  return json_of(spec);
}

RunSpec run_spec_from_json(const nlohmann::ordered_json& json) {
  try {
    RunSpec spec;
    read_json(json, spec);
    return spec;
  } catch (const nlohmann::ordered_json::exception& error) {
    throw InputError(fmt::format("run description: {}", json_fault(error)));
  }
}

SlamConfig settings_of(const SystemSpec& system, const SlamConfig& settings) {
  SlamConfig seen = system.takes_settings() ? settings : SlamConfig{};
  for (const auto& [name, value] : system.settings) read_setting(seen, name, value);
  if (!system.weighs_labels()) seen.semantics = seen.semantics.neutralized();
  return seen;
}

std::vector<SharedSlamConfig> parameter_points(const Suite& suite) {
  return suite.sweep.points.empty() ? std::vector<SharedSlamConfig>{suite.slam}
                                    : suite.sweep.points;
}

namespace {

/// The points of the suite that are distinct for a system, in order.
std::vector<SlamConfig> points_of(const SystemSpec& system, const Suite& suite) {
  std::vector<SlamConfig> points;
  for (const SlamConfig& point : parameter_points(suite)) {
    const SlamConfig seen = settings_of(system, point);
    if (std::find(points.begin(), points.end(), seen) == points.end()) points.push_back(seen);
  }
  return points;
}

/// The settings a system maps with, and the points of its queries on that map.
struct Study {
  SlamConfig mapping;
  std::vector<SemanticConfig> points;
};

std::vector<Study> studies_of(const SystemSpec& system, const Suite& suite) {
  const std::vector<SlamConfig> points = points_of(system, suite);
  std::vector<Study> studies;
  if (suite.sweep.map == SweepMap::kFixed) {
    studies.push_back({settings_of(system, suite.slam), {}});
    for (const SlamConfig& point : points) studies.front().points.push_back(point.semantics);
  } else {
    for (const SlamConfig& point : points) studies.push_back({point, {point.semantics}});
  }
  return studies;
}

}  // namespace

std::vector<RunSpec> expand(const Suite& suite) {
  std::vector<RunSpec> runs;
  for (const Environment& environment : suite.environments)
    for (const auto& level : suite.levels) {
      if (!fits(environment, level)) continue;
      for (int trial = 0; trial < suite.trials; ++trial)
        for (const SystemSpec& system : suite.systems) {
          const std::vector<Study> studies = studies_of(system, suite);
          const std::vector<Labels> labels =
              !system.sees_labels() ? std::vector<Labels>{LabelMode::kNone} : suite.labels;
          for (std::size_t s = 0; s < studies.size(); ++s)
            for (const Labels& mode : labels) {
              if (!fits(environment, mode)) continue;
              std::string run = suite.environments.size() > 1 ? environment.name + "-" : "";
              run += system.name;
              if (mode != Labels()) run += fmt::format("-{}", name(mode));
              run += fmt::format("-{}", level_name(level));
              if (studies.size() > 1) run += fmt::format("-p{:02}", s);
              runs.push_back({.name = run + fmt::format("-{}", trial),
                              .environment = environment,
                              .level = level,
                              .vocabulary = suite.vocabulary,
                              .system = system,
                              .labels = mode,
                              .trial = trial,
                              .seed = suite.seed + static_cast<std::uint64_t>(trial),
                              .slam = studies[s].mapping,
                              .points = studies[s].points,
                              .protocol = suite.protocol,
                              .senses = suite.senses,
                              .graded = suite.graded,
                              .episodes = suite.episodes,
                              .map_labels = suite.episodes ? suite.labels.front() : Labels(),
                              .max_frames = suite.max_frames});
            }
        }
    }
  return runs;
}

}  // namespace mh
