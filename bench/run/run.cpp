// SPDX-License-Identifier: Apache-2.0
#include "bench/run/run.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cache/cache.hpp"
#include "bench/inputs/inputs.hpp"
#include "bench/inputs/recorded_camera.hpp"
#include "bench/inputs/run_key.hpp"
#include "bench/plan/check_labels.hpp"
#include "bench/plan/find_program.hpp"
#include "bench/plan/spec_json.hpp"
#include "bench/provenance/digest.hpp"
#include "bench/report/write.hpp"
#include "bench/run/run_one.hpp"
#include "bench/systems/timed.hpp"
#include "bench/world/world.hpp"
#include "sim/world/travel.hpp"
#include "slam/core/counted.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/core/temporary_folder.hpp"

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

/// Checks all inputs that the runs name, each once: outside programs can be started, scenes read,
/// tours driven. Generated scenes and motions are valid by construction.
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

void check_names(const Suite& suite, const std::vector<RunSpec>& specs) {
  std::set<std::string> names;
  for (const RunSpec& spec : specs)
    if (!names.insert(spec.name).second)
      throw InputError(fmt::format("{}: two runs are named '{}': rename an environment or a level",
                                   suite.file.string(), spec.name));
}

std::string views_name(const Suite& suite, const RunSpec& spec) {
  return suite.environments.size() == 1 ? std::string("views.png")
                                        : fmt::format("views-{}.png", spec.environment.name);
}

fs::path real_executable(const fs::path& executable) {
  std::error_code error;
  const fs::path real = fs::canonical(executable, error);
  return error ? executable : real;
}

/// Warns of missing files of finished runs, which will not be rewritten.
void warn_missing_outputs(const Suite& suite, const BenchResults& results,
                          const BenchOptions& options) {
  std::size_t runs = 0;
  std::set<std::string> views;
  for (const RunResult& run : results.runs) {
    runs += fs::exists(options.out / run.spec.name / "estimate.tum") ? 0 : 1;
    if (run.spec.environment.is_recorded()) continue;  // no image is drawn of it
    if (const std::string name = views_name(suite, run.spec); !fs::exists(options.out / name))
      views.insert(name);
  }
  if (runs == 0 && views.empty()) return;
  options.say(fmt::format(
      "warning: {} of finished runs and {} of images are missing from {}; their results are kept, "
      "use another --out to rebuild them",
      counted(runs, "folder"), counted(views.size(), "sheet"), options.out.string()));
}

/// If a scene was changed and changed back, the existing files are from the run in between: they
/// are removed, together with the result, which is rerun, or from next to a failure.
void forget_outdated_runs(Store& store, const std::vector<Job>& jobs, const fs::path& out) {
  for (const Job& job : jobs) {
    const fs::path folder = out / job.spec.name;
    const auto status = store.status(job.key);
    if (!status || !shows_another_run(folder, job.key)) continue;
    if (status == RunStatus::kDone)
      store.forget(job.key);
    else
      remove_run(folder);
  }
}

/// Load average of the last minute, per processor; 0 if unknown.
double load_per_processor() {
  double load = 0;
  if (getloadavg(&load, 1) != 1) return 0;
  return load / std::max(1.0, static_cast<double>(sysconf(_SC_NPROCESSORS_ONLN)));
}

/// @param wall_s  of this process so far, as cpu_s is of it
/// @param world_s, products_s  CPU time in addition to what `run` recorded
RunCost cost_of_this_process(const RunResult& run, double wall_s, double world_s, double products_s,
                             const SingleRunOptions& order) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {.wall_s = wall_s,
          .cpu_s = processor_time_s(),
          .slam_s = run.times.processor_s,
          .frames_s = world_s + run.frames_s,
          .products_s = products_s + run.products_s,
          .max_rss_mb = static_cast<double>(usage.ru_maxrss) / 1024.0,
          .circumstances = {.host = {},
                            .session_start = order.session_start,
                            .jobs = order.jobs,
                            .load = load_per_processor()}};
}

/// Space for the images of each environment at work.
std::uint64_t limit_of_images(const std::vector<Job>& jobs, const BenchOptions& options) {
  std::set<std::string> all;
  for (const Job& job : jobs) all.insert(job.images);
  const std::size_t at_work = std::min(all.size(), static_cast<std::size_t>(options.jobs));
  return static_cast<std::uint64_t>(1e9 * options.images_limit_gb /
                                    static_cast<double>(std::max<std::size_t>(1, at_work)));
}

}  // namespace

std::string images_of(const RunSpec& run) {
  const nlohmann::ordered_json json = to_json(run);
  return text_key(json.at("environment").dump() + json.at("level").dump() +
                  json.at("max_frames").dump());
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  char slash = 0, more = 0;
  if (std::sscanf(text.c_str(), "%zu%c%zu%c", &shard.index, &slash, &shard.of, &more) != 3 ||
      slash != '/' || shard.index < 1 || shard.index > shard.of ||
      text.find('-') != std::string::npos)
    throw InputError(fmt::format("shard '{}' is not i/n with 1 <= i <= n", text));
  return shard;
}

BenchResults run_suite(const Suite& suite, const SuiteOverrides& overrides,
                       const BenchOptions& options) {
  const std::vector<RunSpec> specs = expand(suite);
  check_names(suite, specs);
  for (const std::string& line : suite.left_out) options.say(line);

  std::set<std::string> warned;
  for (const RunSpec& spec : specs)
    if (spec.system.is_outside() && warned.insert(spec.system.name).second)
      if (const std::string warning = unseen_program(spec.system.outside); !warning.empty())
        options.say(warning);

  std::optional<InputReader> inputs(std::in_place, options.say);
  std::vector<Job> mine;
  std::vector<std::pair<std::string, std::string>> plan;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    plan.emplace_back(specs[i].name, run_key(specs[i], inputs->inputs_of(specs[i])));
    if (i * options.shard.of / specs.size() + 1 == options.shard.index)
      mine.push_back(
          {specs[i], plan.back().second, options.images_limit_gb > 0 ? images_of(specs[i]) : ""});
  }
  const fs::path results = options.out / "results.sqlite";
  if (fs::exists(results)) {
    Store before(results);
    before.check();
    if (options.retry_failed)
      for (const Job& job : mine) before.forget_failure(job.key);
    if (!options.metrics_only) forget_outdated_runs(before, mine, options.out);
    std::erase_if(mine, [&](const Job& job) { return before.status(job.key).has_value(); });
  }
  validate_inputs(mine, *inputs, options.say);  // bad input leaves no file
  inputs.reset();                               // it keeps a scene in memory

  Store store(results);
  store.plan(suite, overrides, plan);
  options.say(fmt::format("{}, {} of them to do", counted(specs.size(), "run"), mine.size()));

  if (!mine.empty()) {
    const TemporaryFolder work(options.out);
    const fs::path cache = options.cache ? *options.cache : work.path() / "cache";
    if (options.cache)
      if (const std::string why = Cache(cache).why_unwritable(); !why.empty())
        options.say(fmt::format(
            "warning: the cache keeps nothing, light is baked anew in each run: {}", why));
    const fs::path images = work.path() / "images";
    const std::uint64_t images_limit = limit_of_images(mine, options);
    const std::string session_start = utc_now();
    PoolOptions pool;
    pool.jobs = options.jobs;
    pool.time_limit_s = options.time_limit_s;
    pool.memory_limit_mb = options.memory_limit_mb;
    pool.executable = real_executable(options.executable);
    pool.work_folder = work.path();
    pool.arguments = [&](const Job& job, const fs::path& description) {
      std::vector<std::string> arguments{"run-one",         description.string(),
                                         "--store",         store.file().string(),
                                         "--key",           job.key,
                                         "--folder",        options.out.string(),
                                         "--cache",         cache.string(),
                                         "--views",         views_name(suite, job.spec),
                                         "--jobs",          std::to_string(options.jobs),
                                         "--session-start", session_start,
                                         "--parent",        std::to_string(getpid())};
      if (options.cache) arguments.insert(arguments.end(), {"--maps", cache.string()});
      if (!job.images.empty() && !job.spec.environment.is_recorded())
        arguments.insert(arguments.end(), {"--images", (images / job.images).string(),
                                           "--images-limit", std::to_string(images_limit)});
      if (options.metrics_only) arguments.emplace_back("--metrics-only");
      return arguments;
    };
    pool.forget_images = [&](const std::string& name) {
      std::error_code no_matter;
      if (!name.empty()) fs::remove_all(images / name, no_matter);
    };
    pool.say = options.say;
    pool.progress = options.progress;
    run_pending(store, std::move(mine), pool);
  }
  store.check();
  BenchResults made = load_results(store, suite);
  if (!options.metrics_only) warn_missing_outputs(suite, made, options);
  return made;
}

void execute_run(const SingleRunOptions& order) {
  const auto start = std::chrono::steady_clock::now();
  const auto json = nlohmann::ordered_json::parse(read_file(order.description), nullptr, false);
  const RunSpec spec = run_spec_from_json(json);
  double world_s = 0, products_s = 0;
  const World world = [&] {
    const ProcessorTimer timer(world_s);
    const auto baked = [&](double share) {
      order.status(fmt::format("light {:.0f} %", 100 * share));
    };
    return build_world(spec, order.jobs, Cache(order.cache), order.say, baked, order.images);
  }();
  if (run_key(spec, world.inputs) != order.key)
    throw InputChanged(fmt::format(
        "{}: a file that it reads was changed after the suite was begun: start the suite again",
        spec.name));
  const fs::path folder = order.folder / spec.name;
  make_output_folder(folder);
  if (!order.metrics_only) remove_run(folder);
  const RunResult run = run_one(spec, world,
                                {.folder = folder,
                                 .progress = order.progress,
                                 .status = order.status,
                                 .system = {},
                                 .tamper = {},
                                 .occupancy = !order.metrics_only,
                                 .maps = Cache(order.maps)});
  if (!order.metrics_only) {
    const ProcessorTimer timer(products_s);
    write_run(folder, world, run, order.key);
    // One process makes the contact sheet; if two start it, both write the same bytes.
    if (world.simulated) write_views(order.folder / order.views, world, spec);
  }
  const double wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Store(order.store)
      .put(order.key, run, cost_of_this_process(run, wall_s, world_s, products_s, order));
}

}  // namespace mh
