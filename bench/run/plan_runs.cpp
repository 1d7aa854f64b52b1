// SPDX-License-Identifier: Apache-2.0
#include "bench/run/plan_runs.hpp"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "bench/inputs/recorded_camera.hpp"
#include "bench/inputs/run_key.hpp"
#include "bench/plan/check_labels.hpp"
#include "bench/plan/find_program.hpp"
#include "bench/run/shard.hpp"
#include "sim/world/travel.hpp"
#include "slam/core/error.hpp"

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
      throw InputError(fmt::format("{}: was taken with another camera than {}: a system has one",
                                   sequence, e.sequence));
    camera = opened.sequence->camera();
    if (opened.sequence->truth() == nullptr)
      say(
          fmt::format("warning: {}: has no ground truth: answers are successes, and "
                      "nothing is said of correct ones, of distances and of the trajectory",
                      sequence));
  }
}

void check_names(const Suite& suite, const std::vector<RunSpec>& specs) {
  std::set<std::string> names;
  for (const RunSpec& spec : specs)
    if (!names.insert(spec.name).second)
      throw InputError(fmt::format("{}: two runs are named '{}': rename an environment or a level",
                                   suite.file.string(), spec.name));
}

}  // namespace

std::vector<Job> plan_runs(const Suite& suite, InputReader& inputs,
                           const std::function<void(std::string_view)>& say) {
  const std::vector<RunSpec> specs = expand(suite);
  check_names(suite, specs);
  for (const std::string& line : suite.left_out) say(line);
  std::set<std::string> warned;
  for (const RunSpec& spec : specs)
    if (spec.system.is_outside() && warned.insert(spec.system.name).second)
      if (const std::string warning = unseen_program(spec.system.outside); !warning.empty())
        say(warning);
  std::vector<Job> jobs;
  std::map<std::string, std::string> environment_of;  // by key
  for (const RunSpec& spec : specs) {
    jobs.push_back({spec, run_key(spec, inputs.inputs_of(spec)), images_of(spec)});
    const std::string& name = spec.environment.name;
    const auto [known, is_new] = environment_of.try_emplace(jobs.back().key, name);
    if (known->second != name)
      throw InputError(fmt::format(
          "{}: environments '{}' and '{}' are equal in every byte that a run reads: statistics "
          "take environments for independent",
          suite.file.string(), known->second, name));
  }
  return jobs;
}

std::vector<std::pair<std::string, std::string>> keys_by_name(const std::vector<Job>& jobs) {
  std::vector<std::pair<std::string, std::string>> keys;
  for (const Job& job : jobs) keys.emplace_back(job.spec.name, job.key);
  return keys;
}

void validate_inputs(const std::vector<Job>& jobs, InputReader& inputs,
                     const std::function<void(std::string_view)>& say) {
  std::set<std::string> programs;
  std::set<std::pair<std::string, bool>> checked;  // recordings, and whether with labels
  struct Uses {
    std::set<std::tuple<fs::path, fs::path, std::optional<fs::path>>>
        drives;  // robot, tour, pedestrian
    std::set<LabelMode> labels;
  };
  std::map<std::pair<fs::path, SceneFrame>, Uses> uses_of;  // of each scene
  for (const Job& job : jobs) {
    const RunSpec& spec = job.spec;
    if (spec.system.is_outside() && programs.insert(spec.system.name).second)
      require_program(spec.system.outside);
    const Environment& e = spec.environment;
    if (e.is_recorded()) {
      if (checked.insert({e.name, spec.labels == LabelMode::kRecorded}).second)
        check_recordings(e, spec.labels, say);
      continue;
    }
    const auto note = [&](const fs::path& scene, const std::optional<fs::path>& tour,
                          const std::optional<fs::path>& pedestrian = {}) {
      if (is_generated(scene)) return;
      Uses& uses = uses_of[{scene, e.frame}];
      uses.labels.insert(spec.labels.mode);
      if (tour && !is_generated(*tour)) uses.drives.insert({e.robot, *tour, pedestrian});
    };
    note(e.scene, e.mapping_tour, e.pedestrian);
    note(e.scene, e.kidnapped_tour);
    note(e.query_scene.value_or(e.scene), e.query_tour);
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

std::string views_name(const Suite& suite, const RunSpec& spec) {
  return suite.environments.size() == 1 ? std::string("views.png")
                                        : fmt::format("views-{}.png", spec.environment.name);
}

}  // namespace mh
