// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench/audit/diagnosis.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/store/store.hpp"
#include "slam/io/error.hpp"

namespace mh::cli {
namespace {

struct DiagnoseArguments {
  std::string results, cache;
  bool json = false;
};

void run(const DiagnoseArguments& options) {
  const std::filesystem::path file = std::filesystem::path(options.results) / "results.sqlite";
  if (!std::filesystem::is_directory(options.results))
    throw InputError(fmt::format("{}: is no folder of `bench`", options.results));
  if (!std::filesystem::exists(file))
    throw InputError(fmt::format("{}: holds no results of `bench`", options.results));
  const Store store(file);
  const BenchResults results = load_results(store, store.planned_suite());
  if (results.runs.empty())
    throw InputError(
        fmt::format("{}: no run of its suite is done; of a stress test, run the dose "
                    "in question with `bench --vary level.DIAL=DOSE`",
                    options.results));
  Progress progress("diagnose");
  const std::vector<Diagnosis> all =
      diagnose(results.runs, {.cache = usual_cache(options.cache),
                              .say = [](std::string_view) {},
                              .progress = [&](double share) { progress.share(share); }});
  progress.end();
  if (options.json)
    fmt::print("{}\n", diagnosis_json(all).dump(2));
  else
    fmt::print("{}", diagnosis_text(all));
}

}  // namespace

void add_diagnose(CLI::App& app) {
  auto options = std::make_shared<DiagnoseArguments>();
  CLI::App* command = app.add_subcommand(
      "diagnose", "Tells what frames have in common at which systems lost themselves.");
  command->add_option("results", options->results, "Folder of `bench`")->required();
  command->add_option("--cache", options->cache,
                      "Cache folder for expensive results (default: $XDG_CACHE_HOME/modelhouse)");
  command->add_flag("--json", options->json, "Prints JSON instead of sentences");
  command->footer("Example:\n  modelhouse diagnose out/model_house");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
