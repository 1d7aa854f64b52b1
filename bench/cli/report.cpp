// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "bench/audit/replay/replay.hpp"
#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/report/pages/place_images.hpp"
#include "bench/report/pages/plot.hpp"
#include "bench/report/pages/write.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/suggest.hpp"

namespace mh::cli {
namespace {

struct ReportArguments {
  std::vector<std::string> results, replay;
  std::string out, cache;
};

/// Repeats the runs whose replay is requested: a run by its name, `failed` (every run with a query
/// that was not answered correctly) or `all`. @throws InputError if no results contain a run of
/// that name.
void add_replays(std::vector<PagesSource>& sources, const ReportArguments& options) {
  const ReplayTools tools{
      .cache = usual_cache(options.cache), .threads = 1, .say = [](std::string_view stage) {
        fmt::print(stderr, "report: {}\n", stage);
      }};
  const auto is_asked = [&](const RunResult& run) {
    bool failed = false;
    for_each_query(run, [&](const QueryScore& q) { failed |= is_judged(q) && !q.correct; });
    return std::ranges::any_of(options.replay, [&](const std::string& word) {
      return word == "all" || (word == "failed" && failed) || word == run.spec.name;
    });
  };
  std::vector<std::string> names{"all", "failed"};
  std::size_t without = 0;
  for (PagesSource& source : sources)
    for (const RunResult& run : source.results.runs) {
      names.push_back(run.spec.name);
      const bool by_name = std::ranges::count(options.replay, run.spec.name) > 0;
      const bool can = run.spec.system.takes_settings() && !run.spec.environment.is_recorded() &&
                       !run.spec.episodes;
      if (!is_asked(run)) continue;
      if (!can && !by_name) {
        ++without;
        continue;
      }
      Replay replay = make_replay(run, tools);
      source.replay_of[run.spec.name] = std::move(replay.scene);
      source.views_of[run.spec.name] = std::move(replay.views);
    }
  if (without > 0)
    fmt::print(stderr,
               "report: {} of recordings, of episodes or of systems other than ours, which have no "
               "replay\n",
               counted(without, "run is", "runs are"));
  for (const std::string& word : options.replay)
    if (std::ranges::count(names, word) == 0)
      throw InputError(fmt::format("--replay: no run is named '{}'{}", word, hint(word, names)));
}

/// Labels folders of the same name with as much of their paths as is needed to tell them apart.
void name_apart(std::vector<PagesSource>& sources) {
  const auto tail = [](const PagesSource& source, std::size_t parts) {
    const auto whole = std::filesystem::absolute(source.folder).lexically_normal();
    std::filesystem::path name;
    for (auto part = whole.end(); part != whole.begin() && parts > 0;)
      if (!(--part)->empty()) name = name.empty() ? *part : *part / name, --parts;
    return name.string();
  };
  for (std::size_t parts = 1; parts < 20; ++parts) {
    std::set<std::string> names;
    for (const PagesSource& source : sources) names.insert(tail(source, parts));
    if (names.size() < sources.size()) continue;
    if (parts > 1)
      for (PagesSource& source : sources) source.name = tail(source, parts);
    return;
  }
}

void run(const ReportArguments& options) {
  std::vector<PagesSource> sources;
  for (const std::string& folder : options.results) {
    PagesSource source = read_source(folder);
    std::error_code error;
    for (const PagesSource& other : sources)
      if (std::filesystem::equivalent(source.folder, other.folder, error))
        throw InputError(folder + ": is named twice");
    sources.push_back(std::move(source));
  }
  name_apart(sources);
  const OutputFolder folder(options.out, "report", names_of_pages());
  if (!options.replay.empty()) add_replays(sources, options);
  for (PagesSource& source : sources)
    if (source.suite) source.frames = frames_json(source);
  const WrittenPages written = write_pages(options.out, sources);
  for (const PagesSource& source : sources)
    if (!source.problem.empty())
      fmt::print(stderr, "report: {}: {}\n", source.name, source.problem);
  fmt::print("{} in {}, {:.1f} MB: open {}\n", counted(written.files, "file"), options.out,
             static_cast<double>(written.bytes) / 1e6, written.index.string());
  const auto holds_nothing = [](const PagesSource& s) { return !s.suite && s.audit.is_null(); };
  if (std::ranges::all_of(sources, holds_nothing))
    throw InputError("report: none of the results could be read: the pages say why");
}

struct PlotArguments {
  std::string results, out;
  PlotOrder order;
};

void draw(const PlotArguments& options) {
  require_writable(options.out, {options.results});
  write_plot(options.out, read_source(options.results), options.order);
}

void add_plot(CLI::App& app) {
  auto options = std::make_shared<PlotArguments>();
  CLI::App* command = app.add_subcommand("plot",
                                         "Draws a figure or table for a paper: PDF (vectors, fonts "
                                         "embedded) or PNG, as wide as a column.");
  command->add_option("results", options->results, "Folder of results of `bench`")->required();
  CLI::Option* figure =
      command
          ->add_option("--figure", options->order.figure,
                       "Figure of the paper: 2, a run from above; 3, box plots by density of "
                       "objects; 4, error against frames; 5, a run on the grid of its map")
          ->check(CLI::IsMember({2, 3, 4, 5}));
  command
      ->add_option("--table", options->order.table,
                   "Table of the paper: 1, by category; 2, relocalization")
      ->check(CLI::IsMember({1, 2}))
      ->excludes(figure);
  command->add_option("--run", options->order.run,
                      "Run that figures 2 and 5 show (default: the first)");
  command->add_option("--measure", options->order.measure,
                      "Measure that figure 3 shows: ate_rmse_m, held_out.success, ...");
  command->add_option("--width", options->order.width_cm, "Width of a figure, cm")
      ->check(number_between(2.0, 100.0));
  command->add_option("--out", options->out, "File: .pdf or .png")->required();
  command->footer(
      "Example:\n  modelhouse plot out/table1_quick --figure 3 --out figure3.pdf\n"
      "Needs gnuplot (Debian: gnuplot-nox).");
  command->callback([options, command, figure] {
    if (figure->empty() && command->get_option("--table")->empty())
      throw InputError("plot: give either --figure or --table");
    const int number = figure->empty() ? 0 : options->order.figure;
    if (!options->order.run.empty() && number != 2 && number != 5)
      throw InputError(fmt::format("--run {}: is for figures 2 and 5", options->order.run));
    if (!command->get_option("--measure")->empty() && number != 3)
      throw InputError(fmt::format("--measure {}: is for figure 3", options->order.measure));
    if (!command->get_option("--width")->empty() && number == 0)
      throw InputError(
          fmt::format("--width {}: a table is as wide as its columns", options->order.width_cm));
    draw(*options);
  });
}

}  // namespace

void add_report(CLI::App& app) {
  auto options = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand(
      "report", "Writes results as pages for a browser, which open from disk without a network.");
  command
      ->add_option("results", options->results,
                   "Folders of results of `bench`; several are shown side by side")
      ->required();
  command->add_option("--out", options->out, "Folder for the pages")->required();
  command->add_option("--replay", options->replay,
                      "Runs to execute again, so that their pages show scene and landmarks: names, "
                      "`failed` (runs with a query that was not answered correctly) or `all`");
  command->add_option("--cache", options->cache,
                      "Cache folder for light and maps (default: $XDG_CACHE_HOME/modelhouse)");
  command->footer(
      "Example:\n  modelhouse report out/model_house --out out/model_house/report\n"
      "Open index.html in that folder; see docs/report.md.");
  command->callback([options] { run(*options); });
  add_plot(app);
}

}  // namespace mh::cli
