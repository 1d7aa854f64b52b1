// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/set_option.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/report/episode_record.hpp"
#include "bench/run/one/run_one.hpp"
#include "bench/run/plan_runs.hpp"
#include "bench/suite/cache.hpp"
#include "bench/suite/json_fields.hpp"
#include "bench/systems/outside_error.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/suggest.hpp"

namespace mh::cli {
namespace {

struct EpisodeArguments {
  std::string suite, out, system, environment, variant, cache;
  SetOption set;
  std::size_t start = 0;
  bool no_cache = false, json = false;
};

/// The run that the options select (by default the first), reduced to the selected variant and to
/// the starts up to the selected one.
RunSpec chosen_run(const Suite& suite, const EpisodeArguments& options) {
  const auto check = [&](const char* option, const std::string& word,
                         const std::vector<std::string>& all) {
    if (!word.empty() && std::ranges::find(all, word) == all.end())
      throw InputError(fmt::format("{}: '{}' is not in {}{}", option, word, suite.file.string(),
                                   hint(word, all)));
  };
  check("--system", options.system,
        words_of(suite.systems, [](const SystemSpec& s) { return s.name; }));
  check("--environment", options.environment,
        words_of(suite.environments, [](const Environment& e) { return e.name; }));
  check("--variant", options.variant,
        words_of(suite.episodes->variants, [](const EpisodeVariant& v) { return v.name; }));
  check_episodes(suite);
  std::vector<RunSpec> runs = expand(suite);
  RunSpec& run = *std::ranges::find_if(runs, [&](const RunSpec& r) {
    return (options.system.empty() || r.system.name == options.system) &&
           (options.environment.empty() || r.environment.name == options.environment);
  });
  std::vector<EpisodeVariant>& variants = run.episodes->variants;
  if (!options.variant.empty())
    std::erase_if(variants, [&](const EpisodeVariant& v) { return v.name != options.variant; });
  variants.resize(1);
  run.episodes->starts = options.start + 1;
  return run;
}

void run(EpisodeArguments options) {
  resolve(options.suite, Shipped::kSuite);
  SuiteOverrides overrides;
  overrides.set = options.set.values();
  const Suite suite = load_suite(options.suite, overrides);
  if (!suite.episodes)
    throw InputError(fmt::format("{}: has no section `episodes`: its robot is not kidnapped",
                                 suite.file.string()));
  const RunSpec chosen = chosen_run(suite, options);
  const std::filesystem::path out = options.out.empty()
                                        ? std::filesystem::path("out") / (suite.name + "-episode")
                                        : std::filesystem::path(options.out);
  const OutputFolder folder(out, "episode", {"log.txt", "strip.png", "episode.json", kOutsideLog});

  Progress progress("episode");
  const Cache cache(
      cache_folder(options.cache, options.no_cache).value_or(std::filesystem::path()));
  const World world =
      build_world(chosen, 1, cache, [&](std::string_view stage) { progress.say(stage); });
  std::optional<EpisodeRecord> record;
  const auto observer = [&](const RobotMap& map, const EpisodeStart& start) {
    record.emplace(map, start);
    return [&](const EpisodeMoment& moment) { record->add(moment); };
  };
  EpisodeScore score;
  try {
    const RunResult result =
        run_one(chosen, world,
                {.folder = out,
                 .hidden = {out, cache.folder()},
                 .progress = [&](double share) { progress.share(share, "mapping"); },
                 .maps = cache,
                 .episodes = {.only = WatchedEpisode{options.start, observer}}});
    progress.end();
    score = result.episodes.front();
  } catch (const OutsideError&) {  // the log up to this point may show why
    for (const char* name : {"strip.png", "episode.json"}) std::filesystem::remove(out / name);
    write_atomically(out / "log.txt", record ? record->log_so_far() : "");
    throw;
  }
  const std::string log = record->log(score);
  write_atomically(out / "log.txt", log);
  write_atomically(out / "episode.json", json_of(score).dump(2) + "\n");
  write_image(out / "strip.png",
              record->strip(fmt::format("{}, start {}, {}", chosen.system.name, options.start,
                                        world.variants.front().name),
                            score));
  if (options.json)
    fmt::print("{}\n", json_of(score).dump(2));
  else
    fmt::print("{}log, strip.png and episode.json in {}\n", log, out.string());
}

}  // namespace

void add_episode(CLI::App& app) {
  auto options = std::make_shared<EpisodeArguments>();
  CLI::App* command = app.add_subcommand(
      "episode", "Kidnaps the robot once, as a suite does, and shows what it saw and decided.");
  command->add_option("suite", options->suite, "Suite: a file (YAML), or the name of a shipped one")
      ->required();
  command->add_option("--system", options->system,
                      "One of the suite's systems (default: the first)");
  command
      ->add_option("--start", options->start,
                   "Number of the start, from 0; may exceed the suite's `starts`")
      ->check(CLI::Range(0, 99999));
  command->add_option("--environment", options->environment,
                      "One of the suite's environments (default: the first)");
  command->add_option("--variant", options->variant,
                      "One of the suite's variants (default: the first)");
  command->add_option("--out", options->out,
                      "Folder for log.txt, strip.png and episode.json (default: "
                      "out/<suite>-episode)");
  options->set.add_to(*command);
  command->add_option("--cache", options->cache,
                      "Cache folder for light and maps (default: $XDG_CACHE_HOME/modelhouse)");
  command->add_flag("--no-cache", options->no_cache, "Rebuilds everything, caches nothing");
  command->add_flag("--json", options->json, "Prints the score as JSON instead of the log");
  command->footer("Example:\n  modelhouse episode kidnapped --system semantic --start 3");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
