// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <memory>

#include <fmt/format.h>

#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/results/json.hpp"
#include "bench/results/table.hpp"
#include "bench/results/write.hpp"
#include "bench/run.hpp"
#include "slam/core/files.hpp"

namespace mh::cli {
namespace {

struct Options {
  std::string suite;
  std::string out;
  int jobs = 1;
  std::optional<int> trials;
  std::optional<std::size_t> frames;
  std::optional<std::string> scene;
  bool json = false;
};

void run(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  SuiteOverrides overrides;
  overrides.trials = options.trials;
  overrides.max_frames = options.frames;
  if (options.scene) overrides.scene = *options.scene;
  const Suite suite = load_suite(options.suite, overrides);
  const std::filesystem::path out = options.out.empty() ? std::filesystem::path("out") / suite.name
                                                        : std::filesystem::path(options.out);
  make_output_folder(out);  // before the work: a folder that cannot be written costs no minutes
  remove_older_results(out);

  Progress progress("bench");
  const RunOptions run_options{.jobs = options.jobs,
                               .say = [&](std::string_view stage) { progress.say(stage); },
                               .progress = [&](double share) { progress.share(share); },
                               .finished =
                                   [&](const World& world, RunResult& run) {
                                     write_run(out / run.spec.name, world, run);
                                     const auto views = out / "views.png";
                                     if (!exists(views)) write_views(views, world);
                                     run.volume.reset();
                                   }};
  const std::vector<RunResult> runs = run_all(suite, run_options);
  const auto wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start);
  const std::string table = write_results(out, suite, runs, wall.count());
  if (options.json) {
    fmt::print("{}\n", results_json(suite, runs).dump(2));
    return;
  }
  fmt::print("{}\n{}\nresults in {} ({})\n", table, times_table(suite, runs), out.string(),
             readable_time(wall.count()));
}

}  // namespace

void add_bench(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "bench", "Runs a suite: drives, maps, relocalizes, scores; prints the table.");
  command->add_option("suite", options->suite, "Suite (YAML)")->required();
  command->add_option("--out", options->out, "Folder for the results (default: out/<suite>)");
  command->add_option("--jobs", options->jobs, "Runs at work at a time; never changes a result")
      ->check(CLI::Range(1, 1024));
  command->add_option("--trials", options->trials, "Repeats with seeds 0 .. N-1")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--frames", options->frames, "Cuts the tours after N frames, for a quick look")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--scene", options->scene, "Another scene or mesh file in the suite's place");
  command->add_flag("--json", options->json, "Prints results.json instead of the table");
  command->footer(
      "Examples:\n  modelhouse bench bench/suites/model_house.yaml --jobs 2\n"
      "  modelhouse bench bench/suites/model_house.yaml --scene house.glb --frames 600");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
