// SPDX-License-Identifier: Apache-2.0
#include <wordexp.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "bench/audit/audit.hpp"
#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/finish.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/scene_option.hpp"
#include "bench/cli/set_option.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/cli/write_audit.hpp"
#include "bench/run/run_suite.hpp"
#include "bench/run/signal_watch.hpp"
#include "bench/run/slurm.hpp"
#include "bench/suite/cache.hpp"
#include "bench/suite/protocol_config.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/settings_io.hpp"

namespace mh::cli {
namespace {

struct BenchArguments {
  std::string suite;
  std::string out;
  int jobs = 1;
  std::optional<int> trials;
  std::optional<std::size_t> frames;
  std::optional<std::string> scene;
  SceneFrameOption frame;
  SetOption set;
  std::vector<std::string> vary;
  std::string shard = "1/1";
  std::string cache;
  bool no_cache = false;
  bool retry_failed = false;
  bool audit = false;
  int live_port = 0;
  std::optional<std::size_t> slurm;
  std::string sbatch;
  std::vector<std::string> arguments_of_part;  // as given; --slurm passes them on to the shares
  double time_limit_s = BenchOptions{}.time_limit_s;
  double memory_limit_mb = 0;
  double images_limit_gb = BenchOptions{}.images_limit_gb;
  bool json = false;
};

void print_settings() {
  SettingsWriter writer(true);
  writer.section("protocol");
  const ProtocolConfig config;
  fields(config, writer);
  fmt::print("{}", writer.text());
}

/// The default folder. A quick look gets its own folder, so that it does not replace the full
/// results.
std::filesystem::path usual_folder(const Suite& suite, bool varied) {
  std::string name = suite.name;
  if (suite.max_frames) name += fmt::format("-first-{}", *suite.max_frames);
  if (varied) name += "-varied";
  return std::filesystem::path("out") / name;
}

/// The words of a text, as a shell splits and expands them.
std::vector<std::string> words_in(const std::string& option, const std::string& text) {
  wordexp_t found{};
  if (wordexp(text.c_str(), &found, WRDE_NOCMD | WRDE_UNDEF) != 0)
    throw InputError(
        fmt::format("{} '{}': cannot be split into words as by a shell", option, text));
  std::vector<std::string> words(found.we_wordv, found.we_wordv + found.we_wordc);
  wordfree(&found);
  return words;
}

void run_shares(const Suite& suite, const SuiteOverrides& overrides, BenchOptions bench,
                const BenchArguments& options) {
  if (bench.shard.of > 1) throw InputError("--slurm: makes the shards itself: leave out --shard");
  if (options.audit) throw InputError("--slurm: audits nothing: run `audit` afterward");
  SlurmOptions slurm{.shares = *options.slurm,
                     .sbatch = words_in("--sbatch", options.sbatch),
                     .arguments = {"bench", options.suite}};
  std::ranges::copy(options.arguments_of_part, std::back_inserter(slurm.arguments));
  std::vector<std::string> names = names_written(bench.out, suite);
  if (!names.empty()) names.emplace_back("slurm");
  const OutputFolder folder(bench.out, "bench", names);
  Progress progress("bench");
  bench.say = [&](std::string_view stage) { progress.say(stage); };
  const SlurmResults made = run_on_slurm(suite, overrides, bench, slurm);
  progress.end();
  std::string missing;
  if (!made.incomplete.empty())
    missing = fmt::format("{} missing, from share {} of {}; see {}; the same command continues",
                          counted(made.results.missing.size(), "run"),
                          fmt::join(made.incomplete, ", "), *options.slurm,
                          share_folder(bench.out, made.incomplete.front()).string() + ".log");
  if (!made.results.failed.empty() && !missing.empty()) progress.say(missing);
  finish(bench.out, suite, made.results, options.json);
  if (!missing.empty()) throw MachineError(missing);
}

void run(BenchArguments options) {
  interrupts_go_on();
  resolve(options.suite, Shipped::kSuite);
  if (options.scene) resolve(*options.scene, Shipped::kScene);
  SuiteOverrides overrides;
  overrides.set = options.set.values();
  overrides.vary = named_values("--vary", options.vary);
  overrides.trials = options.trials;
  overrides.max_frames = options.frames;
  if (options.scene) overrides.scene = *options.scene;
  overrides.frame = options.frame.frame();
  const Suite suite = load_suite(options.suite, overrides);
  BenchOptions bench;
  bench.shard = parse_shard(options.shard);
  bench.out = options.out.empty() ? usual_folder(suite, !overrides.vary.empty())
                                  : std::filesystem::path(options.out);
  bench.jobs = options.jobs;
  bench.cache = cache_folder(options.cache, options.no_cache);
  bench.time_limit_s = options.time_limit_s;
  bench.memory_limit_mb = options.memory_limit_mb;
  bench.images_limit_gb = options.images_limit_gb;
  bench.retry_failed = options.retry_failed;
  bench.live_port = options.live_port;
  if (bench.live_port != 0) {
    if (options.jobs > 1 || options.slurm)
      throw InputError("--live: shows one run at a time: leave out --jobs and --slurm");
    fmt::print(stderr, "bench: live at http://127.0.0.1:{}/ while a run maps\n", bench.live_port);
  }
  if (options.slurm) return run_shares(suite, overrides, bench, options);
  std::vector<std::string> names = names_written(bench.out, suite);
  if (options.audit) {
    if (bench.shard.of > 1) throw InputError("--audit: needs the whole suite: leave out --shard");
    require_auditable(suite);
    if (!names.empty()) std::ranges::move(names_of_audit(), std::back_inserter(names));
  }
  OutputFolder folder(bench.out, "bench", names, OutputFolder::Others::kMayJoin);
  bench.hold = &folder.hold();

  Progress progress("bench");
  bench.say = [&](std::string_view stage) { progress.say(stage); };
  bench.progress = [&](const PoolProgress& p) { show(progress, p); };
  const BenchResults results = run_suite(suite, overrides, bench);
  progress.end();
  finish(bench.out, suite, results, options.json);
  if (!options.audit) return;
  const WrittenAudit audit = write_audit(bench.out, suite, bench.cache);
  if (!options.json) fmt::print("{}", audit.text);
}

}  // namespace

void add_bench(CLI::App& app) {
  auto options = std::make_shared<BenchArguments>();
  CLI::App* command = app.add_subcommand(
      "bench", "Runs a suite: drives, maps, relocalizes, scores; prints the table.");
  command->add_option("suite", options->suite, "Suite: a file (YAML), or the name of a shipped one")
      ->required();
  command->add_option(
      "--out", options->out,
      "Folder for the results (default: out/<suite>; with --frames N out/<suite>-first-N)");
  command
      ->add_option("--jobs", options->jobs,
                   "Runs executed at the same time; does not affect results")
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("--trials", options->trials,
                   "Repeats with seeds 0 .. N-1 (default: the suite's)")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--frames", options->frames,
                   "Cuts the tours after N frames, for a quick look (default: all)")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--scene", options->scene,
                      "Another scene or mesh file (default: the suite's)");
  options->frame.add_to(*command);
  options->set.add_to(*command);
  command
      ->add_option("--vary", options->vary,
                   "SETTING=VALUE,VALUE,...: sweeps over a setting of SLAM, such as "
                   "features.count=500,1000; several: over all combinations")
      ->allow_extra_args(false);
  command->add_option("--shard", options->shard,
                      "i/n: executes the i-th of n shares of the runs, of about equal cost; "
                      "`merge` combines their results");
  CLI::Option* const slurm =
      command
          ->add_option("--slurm", options->slurm,
                       "Submits an array of N tasks to Slurm, each with a share of the runs, waits "
                       "for them and merges their results")
          ->check(CLI::Range(1, 1000));
  command
      ->add_option("--sbatch", options->sbatch,
                   "More options for sbatch: --sbatch=\"--partition=long --mem=8G\"")
      ->needs(slurm);
  command->add_option("--cache", options->cache,
                      "Cache folder for expensive results (default: $XDG_CACHE_HOME/modelhouse)");
  command->add_flag("--no-cache", options->no_cache, "Rebuilds everything, caches nothing");
  command->add_flag("--audit", options->audit,
                    "Audits every query afterward, as `audit` does: maps come from the cache");
  command
      ->add_option(
          "--live", options->live_port,
          "Port of a page on this machine that shows each run while it maps (docs/live.md)")
      ->check(CLI::Range(1, 65535));
  command->add_flag("--retry-failed", options->retry_failed, "Tries failed runs again");
  command
      ->add_option(
          "--time-limit", options->time_limit_s,
          "Seconds for one run, in addition to limit_s of each of its episodes; 0 = no limit")
      ->check(number_between(0.0, 1e9));
  command
      ->add_option("--memory-limit", options->memory_limit_mb,
                   "MB of memory for one run; 0 = no limit")
      ->check(number_between(0.0, 1e9));
  command
      ->add_option("--images-limit", options->images_limit_gb,
                   "GB of disk, in --out, for images that runs share; 0 = each run renders its own")
      ->check(number_between(0.0, 1e6));
  command->add_flag("--json", options->json, "Prints results.json instead of the table");
  command->add_flag_callback(
      "--print-settings",
      [] {
        print_settings();
        throw CLI::Success();
      },
      "Prints a suite's section `protocol`: every setting with its default, meaning and range");
  command->footer(
      "Examples:\n  modelhouse bench model_house --jobs 2\n"
      "  modelhouse bench my_suite.yaml --scene house.glb --frames 600");
  command->callback([=] {
    // Options that are not passed on to a share, such as the output folder: each share has its own.
    const std::set<std::string> not_of_part{"suite",   "--out",   "--json",  "--shard",
                                            "--audit", "--slurm", "--sbatch"};
    for (const CLI::Option* option : command->get_options()) {
      const std::string name = option->get_name();
      if (option->count() == 0 || not_of_part.contains(name)) continue;
      const bool flag = option->get_items_expected_max() == 0;
      for (const std::string& value : option->results())
        options->arguments_of_part.push_back(flag ? name : name + "=" + value);
    }
    run(*options);
  });
}

}  // namespace mh::cli
