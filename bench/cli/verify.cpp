// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/finish.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/set_option.hpp"
#include "bench/run/verify.hpp"
#include "slam/core/digest.hpp"

namespace mh::cli {
namespace {

struct VerifyArguments {
  std::string suite;
  std::optional<std::size_t> frames;
  SetOption set;
  bool json = false;
};

void print_row(const char* what, std::uint64_t first, std::uint64_t second) {
  fmt::print("{:<12}{:>20}{:>20}   {}\n", what, hex(first), hex(second),
             first == second ? "equal" : "DIFFERS");
}

nlohmann::ordered_json to_json(const ExecutionDigests& d) {
  return {{"scene", hex(d.scene)},       {"path", hex(d.path)},   {"images", hex(d.images)},
          {"matching", hex(d.matching)}, {"poses", hex(d.poses)}, {"maps", hex(d.maps)},
          {"results", hex(d.results)}};
}

void print_json(const Verification& v) {
  const nlohmann::ordered_json json = {
      {"jobs_1", to_json(v.first)},
      {"jobs_4", to_json(v.second)},
      {"equal", !v.difference},
      {"first_difference",
       v.difference ? nlohmann::ordered_json(describe(*v.difference)) : nlohmann::ordered_json()}};
  fmt::print("{}\n", json.dump(2));
}

void print_table(const Verification& v) {
  fmt::print("{:<12}{:>20}{:>20}\n", "digest of", "run 1, 1 job", "run 2, 4 jobs");
  print_row("scene", v.first.scene, v.second.scene);
  print_row("path", v.first.path, v.second.path);
  print_row("images", v.first.images, v.second.images);
  print_row("matching", v.first.matching, v.second.matching);
  print_row("poses", v.first.poses, v.second.poses);
  print_row("maps", v.first.maps, v.second.maps);
  print_row("results", v.first.results, v.second.results);
  fmt::print("{}\n", v.difference ? "first difference: " + describe(*v.difference)
                                  : std::string("same input, same bits"));
}

void run(VerifyArguments options) {
  resolve(options.suite, Shipped::kSuite);
  SuiteOverrides overrides;
  overrides.set = options.set.values();
  overrides.max_frames = options.frames;
  const Suite suite = load_suite(options.suite, overrides);
  Progress progress("verify");
  BenchOptions bench;
  bench.say = [&](std::string_view stage) { progress.say(stage); };
  bench.progress = [&](const PoolProgress& p) { show(progress, p); };
  const Verification v = verify(suite, overrides, bench);
  progress.end();
  options.json ? print_json(v) : print_table(v);
  if (v.difference) throw CheckFailed();
}

}  // namespace

void add_verify(CLI::App& app) {
  auto options = std::make_shared<VerifyArguments>();
  CLI::App* command = app.add_subcommand(
      "verify", "Runs a suite twice, with 1 and with 4 jobs, and compares every bit.");
  command->add_option("suite", options->suite, "Suite: a file (YAML), or the name of a shipped one")
      ->required();
  command->add_option("--frames", options->frames, "Cuts the tours after N frames (default: all)")
      ->check(CLI::Range(1, 100000000));
  options->set.add_to(*command);
  command->add_flag("--json", options->json, "Prints JSON");
  command->footer(
      "Example:\n  modelhouse verify model_house --frames 600\n"
      "Exit code 1 if a bit differs; the first frame and stage that differ are named.");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
