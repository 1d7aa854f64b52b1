// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/set_option.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/report/drawing/plot.hpp"
#include "bench/report/stress_report.hpp"
#include "bench/run/signal_watch.hpp"
#include "bench/run/spread.hpp"
#include "bench/run/stress.hpp"
#include "bench/suite/shipped.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/number_in.hpp"

namespace mh::cli {
namespace {

struct StressArguments {
  std::string suite = "stress", out, budget, cache, settings;
  SetOption set;
  int jobs = 1;
  std::optional<std::size_t> frames;
  std::optional<std::uint64_t> seed;
  bool no_cache = false, json = false, spread = false;
};

/// "90s", "30m", "2h" in seconds. @throws InputError
double seconds_of(const std::string& budget) {
  if (budget.empty()) return 0;
  const std::string units = "smh";
  const std::size_t unit = units.find(budget.back());
  const std::optional<double> number = number_in(budget.substr(0, budget.size() - 1));
  if (unit == std::string::npos || !number || !(*number > 0) || !std::isfinite(*number))
    throw InputError(fmt::format("--budget {}: expected a time such as 90s, 30m or 2h", budget));
  constexpr double kSeconds[] = {1, 60, 3600};
  return *number * kSeconds[unit];
}

/// Whether the word names a recording, not a suite.
bool is_recording(const std::string& word) {
  const auto [layout, path] = split_sequence(word);
  return !layout.empty() || std::filesystem::is_directory(path);
}

void run(StressArguments options) {
  interrupts_go_on();
  SuiteOverrides overrides;
  overrides.set = options.set.values();
  overrides.max_frames = options.frames;
  const bool of_recording = is_recording(options.suite);
  if (!of_recording) resolve(options.suite, Shipped::kSuite);
  if (!of_recording && !options.settings.empty())
    throw InputError("--settings: is for a recording; a suite names its own");
  resolve(options.settings, Shipped::kSettings);
  options.spread = options.spread || of_recording;
  Suite suite = of_recording ? suite_of_recording(options.suite, options.settings)
                             : load_suite(options.suite, overrides);
  suite.max_frames = options.frames;
  if (options.seed) suite.seed = *options.seed;
  StressOptions stress_options;
  stress_options.budget_s = seconds_of(options.budget);
  const std::filesystem::path out = options.out.empty() ? std::filesystem::path("out") / suite.name
                                                        : std::filesystem::path(options.out);
  const OutputFolder folder(out, "stress",
                            {"stress.txt", "stress.json", "stress.tex", "stress.png", "stress.html",
                             "spread.txt", "spread.json", "runs"});
  BenchOptions& bench = stress_options.bench;
  bench.out = out / "runs";
  std::filesystem::create_directories(bench.out);
  bench.jobs = options.jobs;
  bench.cache = cache_folder(options.cache, options.no_cache);

  Progress progress("stress");
  bench.say = [&](std::string_view line) { progress.say(line); };
  stress_options.step = [&](double share, std::string_view what) { progress.share(share, what); };
  if (options.spread) {
    const std::vector<Spread> all = find_spread(suite, overrides, stress_options);
    progress.end();
    const std::string text = spread_text(all), json = spread_json(all).dump(2) + "\n";
    write_atomically(out / "spread.txt", text);
    write_atomically(out / "spread.json", json);
    fmt::print("{}", options.json ? json : text);
    return;
  }
  const StressResults results = stress(suite, overrides, stress_options);
  progress.end();
  const std::string text = stress_text(suite, results),
                    json = stress_json(suite, results).dump(2) + "\n";
  write_atomically(out / "stress.txt", text);
  write_atomically(out / "stress.json", json);
  write_atomically(out / "stress.tex", stress_latex(suite, results));
  write_atomically(out / "stress.html", stress_html(suite, results, "stress.png"));
  write_plots(out / "stress.png", stress_plots(suite, results));
  fmt::print("{}", options.json ? json : text);
  if (!options.json) fmt::print("  more: {}\n", (out / "stress.html").string());
  for (const StressCurve& curve : results.curves)
    if (!curve.error.empty() && curve.doses.empty()) throw MachineError(curve.error);
}

}  // namespace

void add_stress(CLI::App& app) {
  auto options = std::make_shared<StressArguments>();
  CLI::App* command =
      app.add_subcommand("stress", "Finds the dose of each fault at which a system breaks.");
  command->add_option("suite", options->suite,
                      "Suite with a section `stress`: a file (YAML), or the name of a shipped one; "
                      "or a recording, for --spread");
  command->add_option("--out", options->out, "Folder for the results (default: out/<suite>)");
  command->add_option("--budget", options->budget,
                      "Begins no further dial after this time: 90s, 30m, 2h (default: no limit)");
  command
      ->add_option("--jobs", options->jobs,
                   "Runs executed at the same time; does not affect results")
      ->check(CLI::Range(1, 1024));
  command->add_option("--frames", options->frames, "Cuts the tours after N frames")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--seed", options->seed, "Seed of all noise (default: the suite's)")
      ->check(seed_number());
  options->set.add_to(*command);
  command->add_option("--cache", options->cache,
                      "Cache folder for expensive results (default: $XDG_CACHE_HOME/modelhouse)");
  command->add_flag("--no-cache", options->no_cache, "Rebuilds everything, caches nothing");
  command->add_flag("--spread", options->spread,
                    "Without truth: how far answers move under changes that should not matter");
  command->add_option("--settings", options->settings,
                      "Calibration of a recording (YAML), or the name of a shipped one (default: "
                      "beside its frames)");
  command->add_flag("--json", options->json, "Prints stress.json instead of the table");
  command->footer(
      "Examples:\n  modelhouse stress --budget 30m --jobs 2\n"
      "  modelhouse stress tum:rgbd_dataset_freiburg1_desk");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
