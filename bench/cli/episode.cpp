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
#include "bench/run/episodes/run_episodes.hpp"
#include "bench/run/episodes/strip.hpp"
#include "bench/run/run_one.hpp"
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

std::optional<std::filesystem::path> episode_cache(const EpisodeArguments& options) {
  if (options.no_cache) return std::nullopt;
  if (!options.cache.empty()) return std::filesystem::absolute(options.cache);
  const std::filesystem::path usual = Cache::default_folder();
  return usual.empty() ? std::nullopt : std::optional(usual);
}

/// The run that the options name; by default the first.
RunSpec chosen_run(const Suite& suite, const EpisodeArguments& options) {
  const std::vector<RunSpec> runs = episode_runs(suite);
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
  for (const RunSpec& run : runs)
    if ((options.system.empty() || run.system.name == options.system) &&
        (options.environment.empty() || run.environment.name == options.environment))
      return run;
  throw InputError(fmt::format("{}: has no such run", suite.file.string()));
}

void run(EpisodeArguments options) {
  resolve(options.suite, Shipped::kSuite);
  SuiteOverrides overrides;
  overrides.set = options.set.values();
  Suite suite = load_suite(options.suite, overrides);
  const RunSpec chosen = chosen_run(suite, options);
  suite.episodes->starts = std::max(suite.episodes->starts, options.start + 1);
  const std::filesystem::path out = options.out.empty()
                                        ? std::filesystem::path("out") / (suite.name + "-episode")
                                        : std::filesystem::path(options.out);
  const OutputFolder folder(out, "episode", {"log.txt", "strip.png", "episode.json", kOutsideLog});

  Progress progress("episode");
  EpisodeOptions episodes;
  episodes.out = out;
  episodes.cache = episode_cache(options);
  episodes.say = [&](std::string_view stage) { progress.say(stage); };
  episodes.progress = [&](double share) { progress.share(share, "mapping"); };
  const OneEpisode one = prepare_episode(suite, chosen, episodes);
  progress.end();
  const auto named = [&](const VariantPlace& place) {
    return options.variant.empty() || place.variant.name == options.variant;
  };
  const VariantPlace& variant = *std::ranges::find_if(one.world.variants, named);
  const EpisodeStart& start = variant.starts[options.start];
  EpisodeRecord record(one.mapped.map, start);
  EpisodeScore score;
  try {
    score = run_episode(episode_place(chosen, one.world, variant, one.mapped), *suite.episodes,
                        start, [&](const EpisodeMoment& moment) { record.add(moment); });
  } catch (const OutsideError&) {  // the log up to there may show why
    for (const char* name : {"strip.png", "episode.json"}) std::filesystem::remove(out / name);
    write_atomically(out / "log.txt", record.log_so_far());
    throw;
  }
  const std::string log = record.log(score);
  write_atomically(out / "log.txt", log);
  write_atomically(out / "episode.json", json_of(score).dump(2) + "\n");
  write_image(out / "strip.png", record.strip(fmt::format("{}, start {}, {}", chosen.system.name,
                                                          options.start, variant.variant.name),
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
                   "Number of the start, from 0; the suite's `starts` is no limit")
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
