// SPDX-License-Identifier: Apache-2.0
#include "bench/run/episodes/run_episodes.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/run/episodes/episode_store.hpp"
#include "bench/run/episodes/own_process.hpp"
#include "bench/suite/code_version.hpp"
#include "bench/suite/find_program.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/json_fields.hpp"
#include "bench/suite/run_key.hpp"
#include "bench/systems/outside_error.hpp"
#include "scenes/load.hpp"
#include "sim/world/travel.hpp"
#include "slam/core/digest.hpp"
#include "slam/core/labels.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/occupancy/objects.hpp"

namespace mh {
namespace {

using Slot = std::pair<std::string, std::size_t>;  ///< variant, start

/// Everything about the episodes that decides one of them, except how many there are.
std::string text_of(const EpisodesSpec& spec, const std::vector<InputDigest>& inputs) {
  nlohmann::ordered_json json = json_of(spec);
  json.erase("starts");
  json["code"] = code_of_episodes();
  for (const EpisodeVariant& variant : spec.variants) json["variants"].push_back(variant.name);
  for (const InputDigest& input : inputs) json["inputs"][input.name] = hex(input.digest);
  return json.dump();
}

/// Keys of a run and of its map.
struct Keys {
  std::string run, map;
  friend bool operator==(const Keys&, const Keys&) = default;
};
/// @param read         for the run, by name
/// @param of_variants  for the variants of its episodes
Keys keys_of(const RunSpec& run, const EpisodesSpec& episodes, const std::vector<InputDigest>& read,
             const std::vector<InputDigest>& of_variants) {
  return {text_key(run_key(run, read) + text_of(episodes, of_variants)),
          text_key(map_key(run, read) + fmt::format("every {}", episodes.ticks_per_frame))};
}

/// The same of what its world was built of.
Keys keys_of(const RunSpec& run, const EpisodesSpec& episodes, const EpisodeWorld& built,
             const std::vector<InputDigest>& of_program) {
  std::vector<InputDigest> read = built.world.inputs;
  std::ranges::copy(of_program, std::back_inserter(read));
  std::ranges::sort(read, {}, &InputDigest::name);
  return keys_of(run, episodes, read, built.inputs_of_variants);
}

/// The world of a run's place, whatever system maps it.
EpisodeWorld world_of(RunSpec run, const Suite& suite, const EpisodeOptions& options,
                      const Cache& cache) {
  run.system = {};
  return build_episode_world(labeled(run, suite), *suite.episodes, options.jobs, cache,
                             options.say);
}

bool same_place(const RunSpec& a, const RunSpec& b) {
  return a.environment.name == b.environment.name && a.level == b.level;
}

/// The episodes of one mapped system that are still to run, several at a time.
class Kidnapper {
 public:
  /// @param program  files of the system, which it may read at any time
  Kidnapper(const Suite& suite, const EpisodeRun& run, const ReadRecord& program,
            EpisodeStore& store, const std::function<void()>& done)
      : suite_(suite), run_(run), program_(program), store_(store), done_(done) {}

  /// Stores each score. @param slots  what to run: indices of variants and starts
  void work(const EpisodeWorld& world, const MappedSystem& mapped,
            const std::vector<std::pair<std::size_t, std::size_t>>& slots, int jobs) {
    std::atomic<std::size_t> next = 0;
    std::mutex storing;
    std::exception_ptr failure;
    const auto worker = [&] {
      for (std::size_t k = next++; k < slots.size(); k = next++) try {
          const VariantPlace& variant = world.variants[slots[k].first];
          const EpisodePlace place = episode_place(run_.spec, world, variant, mapped);
          const EpisodeScore score =
              run_episode(place, *suite_.episodes, variant.starts[slots[k].second]);
          const std::scoped_lock lock(storing);
          require_unchanged(program_);
          store_.put(run_.key, run_.spec.name, score);
          done_();
        } catch (...) {
          const std::scoped_lock lock(storing);
          if (!failure) failure = std::current_exception();
          next = slots.size();
        }
    };
    {
      std::vector<std::jthread> helpers;
      for (int t = 1; t < jobs; ++t) helpers.emplace_back(worker);
      worker();
    }
    if (failure) std::rethrow_exception(failure);
  }

 private:
  const Suite& suite_;
  const EpisodeRun& run_;
  const ReadRecord& program_;
  EpisodeStore& store_;
  const std::function<void()>& done_;
};

Suite with_starts(Suite suite, std::optional<std::size_t> starts) {
  if (starts) suite.episodes->starts = std::min(*starts, suite.episodes->starts);
  return suite;
}

}  // namespace

RunSpec labeled(RunSpec run, const Suite& suite) {
  if (run.labels == Labels()) run.labels = suite.labels.front();
  return run;
}

std::vector<RunSpec> episode_runs(const Suite& suite) {
  if (!suite.episodes)
    throw InputError(fmt::format("{}: has no section `episodes`: nobody is kidnapped in it",
                                 suite.file.string()));
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}", suite.file.string(), what));
  };
  for (const std::string& goal : suite.episodes->goals)
    if (!is_thing(class_by_name(goal).value()))
      refuse(fmt::format("episodes.goals: '{}' is never an object of a map", goal));
  if (suite.labels.front() == Labels())
    refuse("labels: 'none' leaves maps without objects: episodes have no goals then");
  if (suite.levels.size() > 1)
    refuse(fmt::format("levels: {}: a place is mapped at one; episodes at others are `variants`",
                       suite.levels.size()));
  if (suite.sweep.points.size() > 1)
    refuse("parameters: a suite with `episodes` sweeps none: give systems settings of their own");
  for (const Environment& environment : suite.environments)
    if (!environment.mapping_tour.empty() && !is_driven(environment.mapping_tour.string()))
      refuse(
          fmt::format("mapping_tour: '{}' is not driven by a robot: its lasers and the height "
                      "of its camera are not known",
                      environment.mapping_tour.string()));
  if (suite.trials != 1)
    refuse(fmt::format("trials: {}: episodes are repeated by their `starts`", suite.trials));
  for (const SystemSpec& system : suite.systems)
    if (system.is_outside()) {
      require_program(*system.outside);
      if (system.outside->mode == OutsideMode::kTrajectory)
        refuse(fmt::format(
            "system '{}': a program that only returns a trajectory cannot be kidnapped: protocol: "
            "conversation or a library can",
            system.name));
    }
  std::vector<RunSpec> runs;
  for (const RunSpec& run : expand(suite))
    if (run.trial == 0 && (run.labels == Labels() || run.labels == suite.labels.front()))
      runs.push_back(run);
  return runs;
}

EpisodePlace episode_place(const RunSpec& run, const EpisodeWorld& world,
                           const VariantPlace& variant, const MappedSystem& mapped) {
  return {.scene = variant.scene,
          .robot = world.world.simulated->robot,
          .level = variant.level,
          .labels = world.labels,
          .system_sees_labels = run.system.sees_labels() && run.labels != Labels(),
          .map = mapped.map,
          .frozen = *mapped.system,
          .truth_from_estimate = mapped.truth_from_estimate,
          .variant = variant.variant.name,
          .system_seed = run.seed};
}

std::vector<EpisodeRun> run_episodes(const Suite& given, const EpisodeOptions& options) {
  const Suite suite = with_starts(given, options.starts);
  const Cache cache(options.cache.value_or(std::filesystem::path()));
  std::vector<EpisodeRun> runs;
  std::vector<Keys> keys;
  {
    const std::vector<RunSpec> specs = episode_runs(suite);
    const std::vector<InputDigest> of_variants = read_variants(*suite.episodes);
    InputReader inputs(options.say);
    for (const RunSpec& spec : specs) {
      keys.push_back(
          keys_of(spec, *suite.episodes, inputs.inputs_of(labeled(spec, suite)), of_variants));
      runs.push_back({spec, keys.back().run, {}});
    }
  }
  const std::size_t of_run = suite.episodes->variants.size() * suite.episodes->starts;
  const std::size_t all = of_run * (options.only ? 1 : runs.size());
  std::set<std::string> checked;
  const auto check = [&](const EpisodeRun& run) {  // before anything is mapped
    if (!options.only && checked.insert(run.spec.environment.name).second)
      require_goals(run.spec, *suite.episodes);
  };
  const std::filesystem::path file = options.out / "episodes.sqlite";
  if (!is_there(file)) std::ranges::for_each(runs, check);  // a refused suite leaves no file
  EpisodeStore store(file);
  for (const EpisodeRun& run : runs)
    if (store.load(run.key).size() < of_run) check(run);
  std::size_t done = 0;
  const auto report = [&](double more) {
    options.progress((static_cast<double>(done) + more) / static_cast<double>(all));
  };
  const std::function<void()> one_done = [&] {
    ++done;
    report(0);
  };
  std::optional<EpisodeWorld> world;
  std::optional<RunSpec> built_for;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    EpisodeRun& run = runs[r];
    if (options.only && run.spec.name != *options.only) continue;
    std::map<Slot, EpisodeScore> known;
    for (EpisodeScore& score : store.load(run.key))
      known.emplace(Slot{score.variant, score.start}, std::move(score));
    std::vector<std::pair<std::size_t, std::size_t>> todo;
    for (std::size_t v = 0; v < suite.episodes->variants.size(); ++v)
      for (std::size_t s = 0; s < suite.episodes->starts; ++s)
        if (known.contains({suite.episodes->variants[v].name, s}))
          one_done();
        else
          todo.emplace_back(v, s);
    if (!todo.empty()) {
      if (!built_for || !same_place(*built_for, run.spec)) {
        world.reset();
        world = world_of(run.spec, suite, options, cache);
        built_for = run.spec;
      }
      const ReadScope program;
      if (keys_of(run.spec, *suite.episodes, *world, inputs_of_program(run.spec.system)) != keys[r])
        throw_changed(run.spec);
      const std::filesystem::path folder = options.out / run.spec.name;
      if (run.spec.system.is_outside()) make_output_folder(folder);
      if (run.spec.system.is_library() && !options.arguments.empty()) {
        const auto episodes = static_cast<double>(todo.size());
        run.failure =
            run_in_own_process(run.spec, options, [&](double share) { report(share * episodes); });
        done += todo.size();
      } else {
        try {
          MappedSystem mapped = map_tour(run.spec, *world,
                                         {.folder = folder,
                                          .maps = cache,
                                          .key = keys[r].map,
                                          .hidden = {options.out, cache.folder()},
                                          .say = options.say,
                                          .status = options.status});
          options.say(fmt::format(
              "{}: {} of {} frames mapped, {}; {}", run.spec.name, mapped.tracked, mapped.offered,
              counted(mapped.map.objects.size(), "object"), counted(todo.size(), "kidnapping")));
          const int jobs = run.spec.system.is_outside() ? 1 : options.jobs;
          Kidnapper(suite, run, program.record(), store, one_done).work(*world, mapped, todo, jobs);
          mapped.system->finish();
        } catch (const OutsideError& error) {
          run.failure = error.what();
        }
      }
      if (!run.failure.empty() && !options.only)
        options.say(fmt::format("{}: {}", run.spec.name, run.failure));
      for (EpisodeScore& score : store.load(run.key))
        known.insert_or_assign(Slot{score.variant, score.start}, std::move(score));
    }
    bool failed = false;
    for (std::size_t v = 0; v < suite.episodes->variants.size(); ++v)
      for (std::size_t s = 0; s < suite.episodes->starts; ++s) {
        const std::string& variant = suite.episodes->variants[v].name;
        if (const auto found = known.find({variant, s}); found != known.end()) {
          run.scores.push_back(found->second);
          continue;
        }
        run.scores.push_back(score_at_start(variant, world->variants[v].starts[s]));
        run.scores.back().reason = failed ? "not_run" : "system_failed";
        failed = true;  // they run in this order: it failed in the first that is missing
      }
  }
  return runs;
}

OneEpisode prepare_episode(const Suite& suite, const RunSpec& run, const EpisodeOptions& options) {
  const Cache cache(options.cache.value_or(std::filesystem::path()));
  OneEpisode one{.world = world_of(run, suite, options, cache), .mapped = {}};
  const Keys keys = keys_of(run, *suite.episodes, one.world, inputs_of_program(run.system));
  one.mapped = map_tour(run, one.world,
                        {.folder = options.out,
                         .maps = cache,
                         .key = keys.map,
                         .hidden = {options.out, cache.folder()},
                         .say = options.say,
                         .progress = options.progress});
  return one;
}

}  // namespace mh
