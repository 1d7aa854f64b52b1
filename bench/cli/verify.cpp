// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>

#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/protocol/digest.hpp"
#include "bench/verify/verify.hpp"

namespace mh::cli {
namespace {

struct Options {
  std::string suite;
  std::optional<std::size_t> frames;
};

void print_row(const char* what, std::uint64_t first, std::uint64_t second) {
  fmt::print("{:<12}{:>20}{:>20}   {}\n", what, hex(first), hex(second),
             first == second ? "equal" : "DIFFERS");
}

void run(const Options& options) {
  const Suite suite = load_suite(options.suite);
  Progress progress("verify");
  const Verification v = verify(suite, {.max_frames = options.frames,
                                        .say = [&](std::string_view stage) { progress.say(stage); },
                                        .progress = [&](double share) { progress.share(share); }});
  fmt::print("{:<12}{:>20}{:>20}\n", "digest of", "run 1, 1 job", "run 2, 4 jobs");
  print_row("scene", v.first.scene, v.second.scene);
  print_row("path", v.first.path, v.second.path);
  print_row("images", v.first.images, v.second.images);
  print_row("matching", v.first.matching, v.second.matching);
  print_row("poses", v.first.poses, v.second.poses);
  print_row("maps", v.first.maps, v.second.maps);
  print_row("results", v.first.results, v.second.results);
  if (!v.difference) {
    fmt::print("same input, same bits\n");
    return;
  }
  fmt::print("first difference: {}\n", describe(*v.difference));
  throw CheckFailed();
}

}  // namespace

void add_verify(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "verify", "Runs a suite twice, with 1 and with 4 jobs, and compares every bit.");
  command->add_option("suite", options->suite, "Suite (YAML)")->required();
  command->add_option("--frames", options->frames, "Cuts the tours after N frames")
      ->check(CLI::Range(1, 100000000));
  command->footer(
      "Example:\n  modelhouse verify bench/suites/model_house.yaml --frames 600\n"
      "Exit code 1 where a bit differs; the first frame and stage are named.");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
