// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/finish.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/set_option.hpp"
#include "bench/results/gate/baseline.hpp"
#include "bench/results/gate/from_runs.hpp"
#include "bench/results/gate/report.hpp"
#include "bench/run/run_suite.hpp"
#include "bench/run/signal_watch.hpp"
#include "bench/suite/cache.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

struct CheckArguments {
  std::string suite, baseline, junit;
  int jobs = 1;
  std::optional<std::size_t> frames;
  SetOption set;
  bool update = false, json = false;
};

fs::path baseline_file(const CheckArguments& options) {
  if (!options.baseline.empty()) return options.baseline;
  return fs::path(options.suite).replace_extension(".baseline.json");
}

/// Returns the folder in which an interrupted check of this suite leaves its finished results, so
/// that the same command can resume. nullopt if the folder cannot be created, or if another process
/// is working in it.
std::optional<OwnedFolder> place_for(const fs::path& suite) {
  const fs::path cache = Cache::default_folder();
  if (cache.empty()) return std::nullopt;
  const std::string name = fs::weakly_canonical(suite).string();
  const fs::path place = cache / "check" / hex(digest_bytes(name.data(), name.size()));
  try {
    make_output_folder(place.parent_path());
    if (auto left = OwnedFolder::take(place)) {
      if (!fs::exists(place / "results.sqlite")) return left;
      try {
        Store::open_to_read(place);
        return left;
      } catch (const InputError&) {
        left->remove();  // damaged: its runs are repeated
      }
    }
    return OwnedFolder::make(place);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

/// @throws InputError if a file that will be written is not one that `check` wrote
void require_own_outputs(const CheckArguments& options) {
  if (!options.junit.empty())
    require_replaceable(options.junit, kJunitHead, "`modelhouse check --junit`",
                        {options.suite, baseline_file(options)});
  if (options.update)
    require_replaceable(baseline_file(options), is_baseline, "`modelhouse check --update`",
                        {options.suite});
}

/// Runs the suite. Earlier results are reused only if they are from the same check, interrupted.
/// From the cache, only light and detections are used, since their keys cover everything that
/// determines them; runs that store no images never take maps from the cache.
/// @param inputs  reads the inputs; some may have been read already
Baseline measure(const Suite& suite, const CheckArguments& of, InputReader& inputs,
                 Progress& progress) {
  std::optional<OwnedFolder> place = place_for(suite.file);
  std::optional<TemporaryFolder> folder;
  if (!place) folder.emplace(fs::temp_directory_path());
  Baseline made{.suite = suite.name,
                .suite_digest = gate_suite_digest(suite, inputs),
                .origin = gate_origin(),
                .settings = gate_settings(suite, inputs)};
  const fs::path usual = Cache::default_folder();
  const BenchOptions options{.out = place ? place->path() : folder->path(),
                             .jobs = of.jobs,
                             .shard = {},
                             .cache = usual.empty() ? std::nullopt : std::optional(usual),
                             .retry_failed = true,
                             .metrics_only = true,
                             .inputs = &inputs,
                             .say = [&](std::string_view stage) { progress.say(stage); },
                             .progress = [&](const PoolProgress& p) { show(progress, p); }};
  SuiteOverrides overrides;
  overrides.set = of.set.values();
  overrides.max_frames = of.frames;
  BenchResults results;
  try {
    results = run_suite(suite, overrides, options);
  } catch (Interrupted& interrupted) {
    interrupted.goes_on = place.has_value();
    throw;
  } catch (...) {
    if (place && !fs::exists(place->path() / "results.sqlite")) place->remove();
    throw;
  }
  if (place) place->remove();
  require_own_outputs(of);  // again: they may have appeared meanwhile
  if (!results.failed.empty()) {
    if (!of.junit.empty()) write_atomically(of.junit, failures_junit(results.failed, suite.name));
    throw_failures(results.failed, results.failed.front().error, "");
  }
  made.runs = figures(results.runs);
  return made;
}

void report(const CheckArguments& options, const GateResult& result, const std::string& suite) {
  if (!options.junit.empty()) write_atomically(options.junit, gate_junit(result, suite));
  if (options.json)
    fmt::print("{}\n", gate_json(result, suite).dump(2));
  else
    fmt::print("{}", gate_report(result, suite));
}

GateResult judge(const Suite& suite, const Baseline& before, const Baseline& now) {
  const std::vector<std::string> changed = changed_settings(before, now);
  GateResult result =
      compare(before.runs, now.runs, suite.gate, before.origin == now.origin && changed.empty());
  result.changed_settings = changed;
  result.settings_known = !before.settings.is_null();
  return result;
}

/// Shows what a new baseline changes, if the old baseline contains the same runs, and writes the
/// new one.
void update(const CheckArguments& options, const Suite& suite, const Baseline& now) {
  const fs::path file = baseline_file(options);
  if (fs::exists(file)) {
    try {
      const Baseline before = load_baseline(file);
      report(options, compare(before.runs, now.runs, suite.gate, false), suite.name);
    } catch (const InputError& error) {
      fmt::print("cannot be compared with the previous baseline: {}\n", error.what());
    }
  }
  save_baseline(now, file);
  fmt::print("{}: {} written\n", file.string(), counted(now.runs.size(), "run"));
}

void run(CheckArguments options) {
  resolve(options.suite, Shipped::kSuite);
  SuiteOverrides overrides;
  overrides.set = options.set.values();
  overrides.max_frames = options.frames;
  const Suite suite = load_suite(options.suite, overrides);
  if (suite.gate.tolerances.empty() && suite.gate.of_scenario.empty())
    throw InputError(
        fmt::format("{}: check: tolerances: missing: nothing would be judged", options.suite));
  for (const SystemSpec& system : suite.systems)
    if (!system.repeatable && suite.trials < kFewestRuns)
      throw InputError(fmt::format(
          "{}: trials: {}: system '{}' is not repeatable: at least {} are needed to judge it",
          options.suite, suite.trials, system.name, kFewestRuns));
  require_own_outputs(options);
  Progress progress("check");
  InputReader inputs([&](std::string_view stage) { progress.say(stage); });
  if (options.update) return update(options, suite, measure(suite, options, inputs, progress));

  const fs::path file = baseline_file(options);
  if (!fs::exists(file))
    throw InputError(
        fmt::format("{}: cannot be read: no such baseline; --update makes one", file.string()));
  const Baseline baseline = load_baseline(file);  // first, so that a mistake costs no time
  check_suite(baseline, file, suite.name, gate_suite_digest(suite, inputs));
  const Baseline now = measure(suite, options, inputs, progress);
  const GateResult result = judge(suite, baseline, now);
  report(options, result, suite.name);
  if (!result.passed()) throw CheckFailed();
}

}  // namespace

void add_check(CLI::App& app) {
  auto options = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand(
      "check", "Runs a suite and compares the results with committed figures: a gate for CI.");
  command
      ->add_option("suite", options->suite,
                   "Suite with a section `check`: a file (YAML), or the name of a shipped one")
      ->required();
  command->add_option("--baseline", options->baseline,
                      "Committed figures (default: the suite's name with .baseline.json)");
  command->add_option("--junit", options->junit, "Writes the findings as JUnit XML");
  command
      ->add_option("--jobs", options->jobs,
                   "Runs executed at the same time; does not affect results")
      ->check(CLI::Range(1, 1024));
  command
      ->add_option(
          "--frames", options->frames,
          "Cuts the tours after N frames; the baseline must have the same cut (default: all)")
      ->check(CLI::Range(1, 100000000));
  options->set.add_to(*command);
  command->add_flag("--update", options->update, "Rewrites the baseline and shows the difference");
  command->add_flag("--json", options->json, "Prints JSON");
  command->footer(
      "Examples:\n  modelhouse check ci --jobs 2 --junit check.xml\n"
      "  modelhouse check my_suite.yaml --jobs 2 --update\n"
      "Exit code 1 if something got worse by more than its tolerance.");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
