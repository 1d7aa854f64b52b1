// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/report/export.hpp"
#include "bench/run/run_suite.hpp"
#include "slam/io/files.hpp"

namespace mh::cli {
namespace {

struct ExportArguments {
  std::string store, format = "csv", out;
};

void run(const ExportArguments& options) {
  const std::vector<std::filesystem::path> read = {
      options.store, std::filesystem::path(options.store) / "results.sqlite"};
  if (!options.out.empty()) require_writable(options.out, read);
  const Store store = Store::open_to_read(options.store);
  load_results(store, store.planned_suite());  // throws if a row is damaged
  const std::string text = options.format == "csv"    ? export_csv(store)
                           : options.format == "json" ? export_json(store)
                                                      : export_latex(store);
  if (options.out.empty()) {
    fmt::print("{}", text);
    return;
  }
  constexpr std::size_t kHead = 16;  // bytes that identify our files
  require_replaceable(options.out, std::string_view(text).substr(0, kHead), "`modelhouse export`",
                      read);
  write_atomically(options.out, text);
}

}  // namespace

void add_export(CLI::App& app) {
  auto options = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "Exports the results of a suite as CSV, JSON or LaTeX.");
  command->add_option("store", options->store, "results.sqlite, or the folder that holds it")
      ->required();
  command
      ->add_option("--format", options->format,
                   "csv: a line per run and parameter point; json: "
                   "every table; latex: the rows of the table")
      ->check(one_of_words({"csv", "json", "latex"}));
  command->add_option("--out", options->out, "File (default: standard output)");
  command->footer("Example:\n  modelhouse export out/model_house --format csv --out runs.csv");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
