// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/finish.hpp"
#include "bench/run/merge_parts.hpp"
#include "bench/run/run_suite.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

struct MergeArguments {
  std::string out;
  std::vector<std::string> in;
  bool json = false;
};

void run(const MergeArguments& options) {
  const fs::path out = options.out;
  const std::vector<fs::path> parts(options.in.begin(), options.in.end());
  const std::vector<fs::path> all = mergeable_results(out, parts);  // before writing
  const OutputFolder folder(out, "bench",
                            names_written(out, Store::open_to_read(all.back()).planned_suite()));
  merge_parts(out, parts, [](std::string_view note) { fmt::print(stderr, "merge: {}\n", note); });
  const Store store(out / "results.sqlite");
  const Suite suite = store.planned_suite();
  finish(out, suite, load_results(store, suite), options.json);
}

}  // namespace

void add_merge(CLI::App& app) {
  auto options = std::make_shared<MergeArguments>();
  CLI::App* command =
      app.add_subcommand("merge", "Combines the results of a suite's shards; prints the table.");
  command->add_option("out", options->out, "Folder for all results; may already hold some")
      ->required();
  command->add_option("in", options->in, "Folders of `bench --shard i/n`")->required();
  command->add_flag("--json", options->json, "Prints results.json instead of the table");
  command->footer(
      "Example:\n"
      "  modelhouse bench bench/suites/model_house.yaml --shard 1/2 --out out/part1\n"
      "  modelhouse bench bench/suites/model_house.yaml --shard 2/2 --out out/part2\n"
      "  modelhouse merge out/all out/part1 out/part2");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
