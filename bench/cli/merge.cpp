// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/finish.hpp"
#include "bench/run/run.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

struct MergeArguments {
  std::string out;
  std::vector<std::string> in;
  bool json = false;
};

/// Copies what the output lacks of a file or folder. Each file appears whole or not at all, so that
/// a copy that was stopped by a full disk can be resumed.
void copy_missing(const fs::path& from, const fs::path& to) {
  if (fs::is_directory(from)) {
    make_output_folder(to);
    for (const auto& entry : fs::directory_iterator(from))
      copy_missing(entry.path(), to / entry.path().filename());
  } else if (fs::is_regular_file(from) && !fs::exists(to)) {
    write_atomically(to, read_file(from));
  }
}

/// Copies the folders of runs and the images that the output lacks.
void copy_files(const fs::path& from, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(from)) {
    const std::string name = entry.path().filename().string();
    const bool run = entry.is_directory() && fs::exists(entry.path() / "estimate.tum");
    const bool views = name.starts_with("views") && name.ends_with(".png");
    if (run || views) copy_missing(entry.path(), to / name);
  }
}

void run(const MergeArguments& options) {
  const fs::path results = fs::path(options.out) / "results.sqlite";
  std::vector<fs::path> all;
  if (fs::exists(results)) all.push_back(results);
  for (const std::string& in : options.in) {
    all.push_back(fs::path(in) / "results.sqlite");
    if (!fs::is_regular_file(all.back()))
      throw InputError(fmt::format("{}: holds no results.sqlite", in));
  }
  Store::check_mergeable(all);  // before anything is written
  const OutputFolder folder(
      options.out, "bench",
      names_written(options.out, Store::open_to_read(all.back()).planned_suite()));
  Store store(results);
  for (const std::string& in : options.in) {
    const bool itself = fs::equivalent(in, options.out);
    if (itself || store.merge(fs::path(in) / "results.sqlite") == 0)
      fmt::print(stderr, "merge: {}: holds no result that is not here already\n", in);
    if (!itself) copy_files(in, options.out);
  }
  const Suite suite = store.planned_suite();
  finish(options.out, suite, load_results(store, suite), options.json);
}

}  // namespace

void add_merge(CLI::App& app) {
  auto options = std::make_shared<MergeArguments>();
  CLI::App* command = app.add_subcommand(
      "merge", "Puts the results of a suite's shards together; prints the table.");
  command->add_option("out", options->out, "Folder for all results; may hold some already")
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
