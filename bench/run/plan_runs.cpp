// SPDX-License-Identifier: Apache-2.0
#include "bench/run/plan_runs.hpp"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/protocol/streams.hpp"
#include "bench/protocol/world/variant.hpp"
#include "bench/report/write.hpp"
#include "bench/run/shard.hpp"
#include "bench/suite/check_labels.hpp"
#include "bench/suite/find_program.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "bench/suite/run_key.hpp"
#include "sim/simulation/shared_exposures.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/config/by_name.hpp"
#include "slam/config/slam.hpp"
#include "slam/core/labels.hpp"
#include "slam/files/settings_file.hpp"
#include "slam/io/error.hpp"
#include "slam/occupancy/objects.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Checks that frames of an environment's recordings can be read, with labels if requested.
void check_recordings(const Environment& e, const Labels& labels,
                      const std::function<void(std::string_view)>& say) {
  std::optional<Camera> camera;
  for (const std::string& sequence : {e.sequence, e.queries.value_or("")}) {
    if (sequence.empty()) continue;
    say(fmt::format("checking {}", sequence));
    const bool wanted = labels == LabelMode::kRecorded;
    const OpenedRecording opened = open_recorded(e, sequence, wanted);
    if (wanted && !opened.has_labels)
      throw InputError(fmt::format("{}: holds no labels: take `labels: [none]` for it", sequence));
    require_usable_frames(*opened.sequence);
    if (camera && *camera != opened.sequence->camera())
      throw InputError(
          fmt::format("{}: was recorded with a different camera from {}: a system has only one",
                      sequence, e.sequence));
    camera = opened.sequence->camera();
    if (opened.sequence->truth() == nullptr)
      say(
          fmt::format("warning: {}: has no ground truth: answers count as successes, but correct "
                      "answers, distances and the trajectory are not scored",
                      sequence));
  }
}

/// Warns if a calibration file has SLAM settings that differ from the run's. A suite ignores them,
/// except the readout time, which is a property of the camera.
void warn_of_ignored_settings(const fs::path& file, const RunSpec& run,
                              const std::function<void(std::string_view)>& say) {
  const SlamConfig& of_run = run.slam;
  const SlamConfig of_file = load_settings(file).slam, defaults;
  std::vector<std::string> ignored;
  for (const std::string& name : setting_names())
    if (const std::string text = setting_text(of_file, name);
        (name != "track.readout_s" || run.environment.suite_states_readout) &&
        text != setting_text(defaults, name) && text != setting_text(of_run, name))
      ignored.push_back(fmt::format("{}: {}", name, text));
  if (ignored.empty()) return;
  say(
      fmt::format("warning: {}: its SLAM settings are ignored in a suite (to use them, put them "
                  "under `slam:`): {}",
                  file.string(), fmt::join(ignored, ", ")));
}

/// Checks that the runs' names are distinct and can be folder names.
void check_names(const Suite& suite, const std::vector<RunSpec>& specs) {
  constexpr std::size_t kLongest = 200;  // a file's name has at most 255 bytes
  std::set<std::string> names;
  for (const RunSpec& spec : specs) {
    if (spec.name.size() > kLongest)
      throw InputError(
          fmt::format("{}: the name of run '{}...' has {} characters, at most {} are allowed: "
                      "shorten the name of its environment, system or labels",
                      suite.file.string(), spec.name.substr(0, 40), spec.name.size(), kLongest));
    if (!names.insert(spec.name).second)
      throw InputError(fmt::format("{}: two runs are named '{}': rename an environment or a level",
                                   suite.file.string(), spec.name));
  }
}

/// Finds environments that are the same place under two names.
class Places {
 public:
  Places(const Suite& suite, const InputReader& inputs) : suite_(suite), inputs_(inputs) {}

  /// @throws InputError if another environment reads the same files, or shows the same images, or
  /// if the environment is queried with the images that it maps.
  void add(const Environment& e, const std::string& key) {
    const auto [known, is_new] = environment_of_.try_emplace(key, e.name);
    if (known->second != e.name)
      refuse(known->second, e.name, "are equal in every byte that a run reads");
    if (!e.is_recorded() || !recorded_.try_emplace(e.name, e).second) return;
    if (e.queries && inputs_.share_images(e.sequence, *e.queries))
      throw InputError(fmt::format("{}: '{}': its `queries` have the images of its `sequence`",
                                   suite_.file.string(), e.name));
    for (const auto& [name, other] : recorded_)
      if (name != e.name && inputs_.share_images(e.sequence, other.sequence) &&
          e.queries.has_value() == other.queries.has_value() &&
          (!e.queries || inputs_.share_images(*e.queries, *other.queries)))
        refuse(name, e.name, "have the same images");
  }

 private:
  [[noreturn]] void refuse(const std::string& a, const std::string& b, const char* alike) const {
    throw InputError(fmt::format(
        "{}: environments '{}' and '{}' {}: statistics assume that environments are independent",
        suite_.file.string(), a, b, alike));
  }

  const Suite& suite_;
  const InputReader& inputs_;
  std::map<std::string, std::string> environment_of_;  // by a run's key
  std::map<std::string, Environment> recorded_;        // by name
};

}  // namespace

void check_episodes(const Suite& suite) {
  if (!suite.episodes) return;
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}", suite.file.string(), what));
  };
  for (const std::string& goal : suite.episodes->goals)
    if (!is_thing(class_by_name(goal).value()))
      refuse(fmt::format("episodes.goals: '{}' is never an object in a map", goal));
  if (suite.labels.size() > 1)
    refuse(
        fmt::format("labels: {}: with `episodes`, only one kind is possible, for the robot's map",
                    suite.labels.size()));
  if (suite.labels.front() == Labels())
    refuse("labels: 'none' leaves maps without objects: episodes have no goals then");
  if (suite.levels.size() > 1)
    refuse(fmt::format(
        "levels: {}: a place is mapped at one level; use `variants` for episodes at others",
        suite.levels.size()));
  if (suite.sweep.points.size() > 1)
    refuse("parameters: a suite with `episodes` cannot sweep: give systems settings of their own");
  if (suite.trials != 1)
    refuse(fmt::format("trials: {}: episodes are repeated by their `starts`", suite.trials));
  if (suite.graded) refuse("graded: a suite has either graded queries or `episodes`");
  for (const Environment& environment : suite.environments)
    if (!is_driven(environment.mapping_tour.string()))
      refuse(
          fmt::format("mapping_tour: '{}' is not driven by a robot: its lasers and the height "
                      "of its camera are not known",
                      environment.mapping_tour.string()));
  for (const SystemSpec& system : suite.systems)
    if (system.is_outside() && system.outside->mode == OutsideMode::kTrajectory)
      refuse(fmt::format(
          "system '{}': a program that only returns a trajectory cannot be kidnapped: protocol: "
          "conversation or a library can",
          system.name));
}

std::vector<Job> plan_runs(const Suite& suite, InputReader& inputs,
                           const std::function<void(std::string_view)>& say) {
  check_episodes(suite);
  const std::vector<RunSpec> specs = expand(suite);
  check_names(suite, specs);
  for (const std::string& line : suite.notes) say(line);
  std::set<std::string> outside;
  for (const RunSpec& spec : specs)
    if (spec.system.is_outside() && outside.insert(spec.system.name).second) {
      require_program(*spec.system.outside);
      if (const std::string warning = unseen_program(*spec.system.outside); !warning.empty())
        say(warning);
    }
  std::vector<Job> jobs;
  Places places(suite, inputs);
  std::map<std::string, std::string> name_of;  // by key
  for (const RunSpec& spec : specs) {
    const std::string images = images_of(spec);
    jobs.push_back({.spec = spec,
                    .key = run_key(spec, inputs.inputs_of(spec)),
                    .images = images,
                    .frames = images + "/" + folder_of(shared_noises(spec))});
    places.add(spec.environment, jobs.back().key);
    if (const auto [first, is_new] = name_of.try_emplace(jobs.back().key, spec.name); !is_new)
      throw InputError(fmt::format(
          "{}: runs '{}' and '{}' are equal in every setting and every byte that they read: leave "
          "one of them out",
          suite.file.string(), first->second, spec.name));
  }
  return jobs;
}

PlannedKeys keys_by_name(const std::vector<Job>& jobs) {
  PlannedKeys keys;
  for (const Job& job : jobs) keys.emplace_back(job.spec.name, job.key);
  return keys;
}

void validate_inputs(const std::vector<Job>& jobs, InputReader& inputs,
                     const std::function<void(std::string_view)>& say) {
  std::set<fs::path> calibrations;
  std::set<std::pair<std::string, bool>> checked;  // recordings, with or without labels
  struct Uses {
    std::set<std::tuple<fs::path, fs::path, std::optional<fs::path>>>
        drives;  // robot, tour, pedestrian
    std::set<LabelMode> labels;
  };
  std::map<std::pair<fs::path, SceneFrame>, Uses> uses_of;  // of each scene
  std::set<std::string> with_goals;                         // environments
  for (const Job& job : jobs) {
    const RunSpec& spec = job.spec;
    const Environment& e = spec.environment;
    if (e.is_recorded()) {
      if (e.settings && spec.system.takes_settings() && calibrations.insert(*e.settings).second)
        warn_of_ignored_settings(*e.settings, spec, say);
      if (checked.insert({e.name, spec.labels == LabelMode::kRecorded}).second)
        check_recordings(e, spec.labels, say);
      continue;
    }
    const auto note = [&](const fs::path& scene, const std::optional<fs::path>& tour,
                          const std::optional<fs::path>& pedestrian = {}) {
      if (is_generated(scene)) return;
      Uses& uses = uses_of[{scene, e.frame}];
      uses.labels.insert(labels_of_frames(spec).mode);
      if (tour && !is_generated(*tour)) uses.drives.insert({e.robot, *tour, pedestrian});
    };
    note(e.scene, e.mapping_tour, e.pedestrian);
    note(e.scene, e.kidnapped_tour);
    note(e.queried_scene(), e.query_tour, e.query_pedestrian);
    if (spec.episodes && with_goals.insert(e.name).second) {
      say(fmt::format("checking the goals in {}", e.name));
      require_goals(spec);
    }
  }
  for (const auto& [place, uses] : uses_of) {
    const auto& [file, frame] = place;
    say(fmt::format("checking {}", file.string()));
    const std::shared_ptr<const Scene> scene = inputs.scene(file, frame);
    for (const LabelMode labels : uses.labels)
      if (const std::string warning = check_labels(*scene, labels); !warning.empty())
        say("warning: " + warning);
    for (const auto& [robot, tour, pedestrian] : uses.drives) {
      std::vector<MovingObstacle> others;
      if (pedestrian) others.push_back(as_obstacle(*scene, load_pedestrian(*pedestrian)));
      travel(*scene, load_robot(robot), tour, others);
    }
  }
}

std::string views_name(const Suite& suite, const Environment& environment) {
  return suite.environments.size() == 1 ? std::string("views.png")
                                        : fmt::format("views-{}.png", environment.name);
}

bool is_reused(const Store& store, const Job& job, const std::filesystem::path& out,
               const Reuse& reuse) {
  const auto status = store.status(job.key);
  return status && (reuse.failures || *status == RunStatus::kDone) &&
         !(reuse.files && shows_another_run(out / job.spec.name, job.key));
}

}  // namespace mh
